# SPDX-License-Identifier: BSD-3-Clause
"""Check the symbols of a built library.

check_symbols.py exported NM LIBRARY...   what shared libraries export begins with nt_
check_symbols.py portable NM ARCHIVE      what the core calls is its own, libm's, <string.h>'s, or snprintf
check_symbols.py backend NM OBJECT...     a backend as a shared object calls nothing of this library
"""

import re
import subprocess
import sys

# Everything the core may take from outside: arithmetic, memory blocks, and what a compiler calls on its own. Not cbrt,
# hypot, exp2 and others whose last bit is another on another machine: core/same_bits.h.
PORTABLE = re.compile(
    r"""(mem(cpy|move|set|cmp|chr)|str(len|cmp|ncmp|chr)|(__)?snprintf(_chk)?
    |(sqrt|exp|expm1|log|log2|log10|log1p|pow|fma|fabs|fmod|remainder|ldexp|frexp|scalbn|copysign|nextafter
     |floor|ceil|round|trunc|rint|nearbyint|lround|llround|lrint|fmin|fmax|modf|ilogb
     |sin|cos|tan|asin|acos|atan|atan2|sincos|sinh|cosh|tanh|asinh|atanh|cabs|carg|cexp)f?
    |__(mul|div)dc3 # complex products and quotients, of the compiler's own library
    |__cpu_(model|features2|indicator_init) # which variant of an array kernel this machine can run
    |_GLOBAL_OFFSET_TABLE_|__stack_chk_fail|__(asan|ubsan|tsan|sanitizer)_\w+|__gcov_\w+|_chkstk|___chkstk_ms)""",
    re.VERBOSE,
)


def symbols(*command: str) -> set[str]:
    """Return the names that nm prints, without version suffixes."""
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    return {line.split()[-1].split("@")[0] for line in lines if len(line.split()) >= 2}


def main() -> int:
    """Print the symbols that should not be there and return their number."""
    job, nm, *files = sys.argv[1:]
    wrong: set[str] = set()
    count = 0
    for file in files:
        if job == "exported":
            found = symbols(nm, "--dynamic", "--defined-only", file)
            wrong |= {name for name in found if not name.startswith("nt_")}
        elif job == "backend":
            found = symbols(nm, "--dynamic", file)
            called = symbols(nm, "--dynamic", "--undefined-only", file)
            wrong |= {name for name in called if name.startswith("nt_")} | ({"nanotouch_backend"} - (found - called))
        else:
            found = symbols(nm, "--undefined-only", file) - symbols(nm, "--defined-only", file)
            wrong |= {name for name in found if not PORTABLE.fullmatch(name)}
        count += len(found)
    print("\n".join(f"{job}: {name}" for name in sorted(wrong)) or f"{job}: all {count} symbols are as they should be")
    return min(len(wrong) + (job == "exported" and count == 0), 99)


if __name__ == "__main__":
    sys.exit(main())
