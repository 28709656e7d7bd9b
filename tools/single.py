# SPDX-License-Identifier: BSD-3-Clause
"""Write the touch step in single precision from the sources that have it in double precision.

single.py FOLDER           writes nanotouch_single.h and .c, which need C11 and libm and nothing of this library;
                           nanotouch_single_of.h, which makes their constants from those in double precision; and
                           nanotouch_single_text.hpp, which writes them as C (nanotouch plan --c-header)
single.py FOLDER TEST...   writes tests of the step as tests of the step in single precision, TEST_single.c

The same law is not written twice: double becomes float, 0.5 becomes 0.5f, fabs becomes fabsf, nt_ becomes ntf_. What
adds up over a session (nt_sum) stays double. Only what the step calls is taken, and the table of a plan's force, which
has single precision in the library, too.
"""

import argparse
import re
from collections.abc import Iterator
from pathlib import Path

LIBRARY = Path(__file__).parent.parent / "libnanotouch"
PUBLIC = LIBRARY / "include/nanotouch"
HEADERS = [
    *(PUBLIC / f"{name}.h" for name in ("types", "rig", "settings", "control", "advanced/control", "touch")),
    PUBLIC / "advanced/force_table.h",
    LIBRARY / "internal/control.h",
]
PRIVATE = ["follow", "lift", "modes", "motor", "observe", "sideways", "stuck"]
SOURCES = [
    "control/motor",
    "control/laws",
    "control/stage_loop",
    "control/passivity",
    "control/rescale",
    "control/follow",
    "control/lift",
    "control/stuck",
    "control/supervisor",
    "control/modes",
    "control/sideways",
    "control/observe",
    "control/touch",
    "control/requests",
    "scene/force_table",
]
CALLED = {"hypotenuse": "core/same_bits.h"}  # private functions of other folders

TOKEN = re.compile(r'/\*.*?\*/|"[^"]*"|[A-Za-z_]\w*|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?\w*|\s+|.', re.DOTALL)
FLOATING = re.compile(r"(\d+\.\d*|\.\d+)([eE][+-]?\d+)?|\d+[eE][+-]?\d+")
MATH = {"fabs", "sqrt", "fmin", "fmax", "exp", "expm1", "pow", "round", "floor", "ceil"}
WORDS = {"double": "float", "HUGE_VAL": "HUGE_VALF", "DBL_EPSILON": "FLT_EPSILON"}

NOTE = """/* SPDX-License-Identifier: BSD-3-Clause
 * Made by tools/single.py from nanotouch {version}: do not edit. {what} */
"""
NARROWED = """
#if defined(__GNUC__) /* sums are double, and meant to be narrowed where they leave */
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#endif
"""
CHOICES = """
/* In the type of what they are given: what adds up is double. */
static inline float ntf_lesser(float a, float b)
{
    return a < b ? a : b;
}
static inline float ntf_greater(float a, float b)
{
    return a > b ? a : b;
}
static inline double ntf_lesser_sum(double a, double b)
{
    return a < b ? a : b;
}
static inline double ntf_greater_sum(double a, double b)
{
    return a > b ? a : b;
}
#define lesser(a, b) _Generic((a) + (b), float: ntf_lesser, double: ntf_lesser_sum)(a, b)
#define greater(a, b) _Generic((a) + (b), float: ntf_greater, double: ntf_greater_sum)(a, b)
#define clamp(value, minimum, maximum) lesser(greater(value, minimum), maximum)
"""

TEXT = r"""
#ifndef NANOTOUCH_SINGLE_TEXT_HPP
#define NANOTOUCH_SINGLE_TEXT_HPP

#include <cmath>
#include <cstdio>
#include <string>

#include "nanotouch/touch.h"

/* So many digits that reading them gives the same number. */
static inline std::string nt_digits_text(double value, int digits, const char *suffix)
{
    if (!std::isfinite(value))
        return std::isnan(value) ? "NAN" : value > 0.0 ? "INFINITY" : "-INFINITY";
    char text[40];
    (void)std::snprintf(text, sizeof text, "%.*e%s", digits - 1, value, suffix);
    return text;
}
static inline std::string nt_number_text(float value)
{
    return nt_digits_text((double)value, 9, "f");
}
static inline std::string nt_number_text(double value)
{
    return nt_digits_text(value, 17, "");
}
template <typename kept> static inline std::string nt_row_text(const double *values, int count)
{
    std::string text = "{";
    for (int i = 0; i < count; ++i)
        text += (i ? ", " : "") + nt_number_text((kept)values[i]);
    return text + "}";
}
static inline std::string nt_rows_text(const double (*values)[2], int rows, int columns)
{
    std::string text = "{";
    for (int i = 0; i < rows; ++i)
        text += (i ? ", " : "") + nt_row_text<float>(values[i], columns);
    return text + "}";
}
static inline std::string nt_law_text(nt_control_choice choice)
{
    return choice == NT_CONTROL_PAPER       ? "ntf_servo_paper"
           : choice == NT_CONTROL_IMPEDANCE ? "ntf_servo_impedance"
                                            : "ntf_servo_default";
}
"""


def single(text: str) -> str:
    """Return C text in single precision."""

    def word(token: str) -> str:
        if token.startswith(("/*", '"')):
            return re.sub(r"\bnt_(?=\w)", "ntf_", re.sub(r"\bNT_(?=\w)", "NTF_", token))
        if FLOATING.fullmatch(token):
            return token + "f"
        if token in WORDS:
            return WORDS[token]
        if token in MATH:
            return token + "f"
        return re.sub("^nt_", "ntf_", re.sub("^NT_", "NTF_", token))

    text = re.sub(r"\bNT_(API|REALTIME) ", "", text)
    return "".join(word(token) for token in TOKEN.findall(text)).replace(
        "typedef float ntf_sum", "typedef double ntf_sum"
    )


def items(text: str) -> Iterator[str]:
    """Yield what a header declares, each with the comment above it."""
    yield from re.findall(r"^#define \w+ [^\\\n]+$", text, re.MULTILINE)
    text = re.sub(r'\A/\*.*?\*/|^#[^\n]*$|^extern "C" \{$|^\}$', "", text, flags=re.DOTALL | re.MULTILINE)
    item, depth = "", 0
    for token in TOKEN.findall(text):
        if item or not token.isspace():
            item += token
        depth += (token == "{") - (token == "}")
        if depth == 0 and token == ";":
            yield item
            item = ""


def code_of(item: str) -> str:
    """Return an item without its comments."""
    return re.sub(r"/\*.*?\*/", "", item, flags=re.DOTALL).strip()


def name_of(item: str) -> str:
    """Return what an item declares; of an enum without a name its first constant."""
    name = re.match(
        r"typedef (?:struct|enum) (\w+) \{|#define (\w+)|typedef .*\(\*(\w+)\)|typedef \w+ (\w+);|"
        r"enum \{\s*(\w+)|struct (\w+);|[^(]*?(\w+)\(",
        code_of(item),
    )
    return next(filter(None, name.groups()), "") if name else ""


def is_prototype(item: str) -> bool:
    """Return whether it declares a function."""
    return item.endswith(");") and not code_of(item).startswith("typedef")


def status_enum() -> str:
    """Return the enum that status.h makes of a list."""
    codes = re.findall(r"X\((NT_\w+), ", (PUBLIC / "status.h").read_text())
    return "typedef enum nt_status { " + ", ".join(codes) + " } nt_status;"


def body_of(path: Path) -> str:
    """Return a source without its licence and includes."""
    text = path.read_text().replace("/* SPDX-License-Identifier: BSD-3-Clause\n * ", "/* ", 1)
    return re.sub(r"^#include .*\n", "", text, flags=re.MULTILINE)


def function_of(name: str, path: str) -> str:
    """Return one function of a private header."""
    match = re.search(
        rf"(?:/\*[^/]*\*/\n)?static inline \w+ {name}\(.*?^\}}\n", (LIBRARY / path).read_text(), re.M | re.S
    )
    if match is None:
        raise SystemExit(f"{path} has no {name}")
    return match[0]


def declarations() -> list[str]:
    """Return the declarations that the sources need, in their order, and those that these need."""
    sources = "\n".join(body_of(LIBRARY / f"{name}.c") for name in SOURCES)
    private = "\n".join((LIBRARY / f"control/{name}.h").read_text() for name in PRIVATE)
    defined = set(re.findall(r"^[\w ]+?\*?(nt_\w+)\([^;]*?\)\n\{", sources, re.MULTILINE))
    every = [status_enum(), *(item for header in HEADERS for item in items(header.read_text()))]
    named = [(name_of(item), item) for item in every]
    used = set(re.findall(r"\w+", sources + private))
    while True:
        kept = [
            item
            for name, item in named
            if (name in defined if is_prototype(item) else used & {name, *re.findall(r"\bNT_\w+", code_of(item))})
        ]
        more = used.union(*(re.findall(r"\w+", code_of(item)) for item in kept))
        if more == used:
            return kept
        used = more


def members(item: str) -> Iterator[tuple[str, str, str]]:
    """Yield type, name and dimensions of each member of a struct; of a pointer to a function nothing."""
    inside = code_of(item).split("{", 1)[1].rsplit("}", 1)[0]
    for line in inside.split(";"):
        if match := re.match(r"\s*(\w+) (\w[^()*]*)$", line):
            for each in match[2].split(","):
                name, *dimensions = re.findall(r"\w+", each)
                yield match[1], name, "".join(f"[{size}]" for size in dimensions)


def taken(kind: str, name: str, dimensions: str, structs: dict[str, str]) -> str:
    """Return statements that take one member from its like in double precision."""
    loops = re.findall(r"\w+", dimensions)
    at = "".join(f"[{index}]" for index, _ in zip("ij", loops, strict=False))
    head = "".join(
        f"for (int {index} = 0; {index} < {size}; ++{index}) " for index, size in zip("ij", loops, strict=False)
    )
    if kind in structs:
        return f"    {head}to.{name}{at} = {single(kind)}_of(&from->{name}{at});\n"
    return f"    {head}to.{name}{at} = ({single(kind)})from->{name}{at};\n"


def structs_of(kept: list[str]) -> dict[str, str]:
    """Return the structs that are in double precision here, by name."""
    structs = {name_of(item): item for item in kept if code_of(item).startswith("typedef struct")}
    return {name: item for name, item in structs.items() if not name.startswith("nt_force_")}


def write_conversion(folder: Path, version: str, kept: list[str]) -> None:
    """Write functions that make constants, samples and states from those in double precision."""
    structs = structs_of(kept)
    parts = [NOTE.format(version=version, what="From double to single precision.")]
    parts.append("#ifndef NANOTOUCH_SINGLE_OF_H\n#define NANOTOUCH_SINGLE_OF_H\n")
    parts.append('#include "nanotouch/touch.h"\n#include "nanotouch_single.h"\n')
    for name, item in structs.items():
        body = "".join(taken(*member, structs) for member in members(item))
        if name == "nt_touch":
            body = body.replace(
                "    to.law = (ntf_control_law)from->law;\n", "    to.law = ntf_control_law_of(&to.settings.control);\n"
            )
        parts.append(
            f"static inline {single(name)} {single(name)}_of(const {name} *from)\n{{\n"
            f"    {single(name)} to = {{0}};\n{body}    return to;\n}}\n"
        )
    (folder / "nanotouch_single_of.h").write_text("\n".join(parts) + "\n#endif\n")


def written(line: str, structs: dict[str, str]) -> str:
    """Return the statement that writes one member as C; a pointer is none."""
    match = re.match(r"\s*(\w+) (\w[^()*]*)$", line)
    if match is None:
        return '    text += in + "0, /* none */\\n";\n'
    kind, statements = match[1], ""
    for each in match[2].split(","):
        name, *sizes = re.findall(r"\w+", each)
        value = f"from.{name}"
        if kind == "nt_control_law":
            one = "nt_law_text(from.settings.control.choice)"
        elif kind in structs:
            one = f"nt_text_of({value}, in)"
        elif kind in ("double", "nt_sum"):
            one = f"nt_number_text({'(float)' if kind == 'double' else ''}%s)"
        elif kind in ("int", "uint32_t", "uint64_t"):
            one = "std::to_string(%s)" + ("" if kind == "int" else ' + "u"')
        else:
            one = f'"({single(kind)})" + std::to_string((int)%s)'
        if sizes and kind not in ("double", "nt_sum"):
            raise SystemExit(f"single.py: it writes no array of {kind}")
        if len(sizes) == 2:
            one = f"nt_rows_text({value}, {sizes[0]}, {sizes[1]})"
        elif sizes:
            one = f"nt_row_text<{'float' if kind == 'double' else 'double'}>({value}, {sizes[0]})"
        statements += f'    text += in + {one.replace("%s", value)} + ", /* {name} */\\n";\n'
    return statements


def write_text(folder: Path, version: str, kept: list[str]) -> None:
    """Write functions that write the constants of a touch step as C."""
    structs, wanted = structs_of(kept), {"nt_touch"}
    for name in reversed(structs):  # what a struct holds is declared before it
        if name in wanted:
            wanted |= {kind for kind, *_ in members(structs[name])}
    parts = [NOTE.format(version=version, what="Constants in single precision, as C."), TEXT]
    for name in (name for name in structs if name in wanted):
        inside = code_of(structs[name]).split("{", 1)[1].rsplit("}", 1)[0]
        body = "".join(written(line, structs) for line in inside.split(";") if line.strip())
        parts.append(
            f"static inline std::string nt_text_of(const {name} &from, const std::string &outside)\n{{\n"
            f'    const std::string in = outside + "    ";\n    std::string text = "{{\\n";\n{body}'
            '    return text + outside + "}";\n}\n'
        )
    (folder / "nanotouch_single_text.hpp").write_text("\n".join(parts) + "\n#endif\n")


def write_header(folder: Path, version: str, kept: list[str]) -> None:
    """Write types, constants and prototypes."""
    what = "The touch step in single precision; docs/howto/microcontroller.md."
    head = "#ifndef NANOTOUCH_SINGLE_H\n#define NANOTOUCH_SINGLE_H\n\n#include <stdint.h>\n"
    cplus = '\n#ifdef __cplusplus\nextern "C" {\n#endif\n\n'
    tail = "\n\n#ifdef __cplusplus\n}\n#endif\n#endif\n"
    text = NOTE.format(version=version, what=what) + head + cplus + "\n\n".join(single(item) for item in kept) + tail
    (folder / "nanotouch_single.h").write_text(text)


def write_source(folder: Path, version: str) -> None:
    """Write all functions as one source."""
    parts = [NOTE.format(version=version, what="")]
    parts.append('#include "nanotouch_single.h"\n\n#include <math.h>\n#include <stddef.h>\n' + NARROWED + CHOICES)
    parts += [single(function_of(name, path)) for name, path in CALLED.items()]
    for name in PRIVATE:
        parts += [single(i) for i in items((LIBRARY / f"control/{name}.h").read_text()) if is_prototype(i)]
    for name in SOURCES:
        body = single(body_of(LIBRARY / f"{name}.c"))
        macros = re.findall(r"^#define (\w+)", body, re.MULTILINE)
        parts.append(f"/* --- {name}.c --- */\n{body}\n" + "".join(f"#undef {macro}\n" for macro in macros))
    (folder / "nanotouch_single.c").write_text("\n".join(parts))


def write_tests(folder: Path, sources: list[str]) -> None:
    """Write tests of the double step as tests of the single one."""
    for source in map(Path, sources):
        fixture = source.with_name("supervisor_fixture.h").read_text()
        text = single(source.read_text().replace('#include "supervisor_fixture.h"\n', fixture))
        text = re.sub(r'#include "(?:nanotouch|core)/[\w/]+\.h"', '#include "single_made.h"', text)
        (folder / f"{source.stem}_single.c").write_text(text)


def main() -> None:
    """Write the files."""
    parser = argparse.ArgumentParser(description="Writes the touch step in single precision, or tests of it.")
    parser.add_argument("folder", type=Path, help="where the files go")
    parser.add_argument("tests", nargs="*", help="C tests of the double step: those are written in single precision")
    given = parser.parse_args()
    folder = given.folder
    folder.mkdir(parents=True, exist_ok=True)
    if given.tests:
        write_tests(folder, given.tests)
        return
    version = re.search(r'NT_VERSION "(.*)"', (PUBLIC / "version.h").read_text())
    kept = declarations()
    write_header(folder, version[1] if version else "", kept)
    write_source(folder, version[1] if version else "")
    write_conversion(folder, version[1] if version else "", kept)
    write_text(folder, version[1] if version else "", kept)


if __name__ == "__main__":
    main()
