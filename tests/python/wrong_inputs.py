# SPDX-License-Identifier: BSD-3-Clause
"""Wrong inputs to the command, with words of the answer: files, and tables of ``arguments | words | words``."""

from __future__ import annotations

import os
import shlex
from pathlib import Path

DIGITS = "9" * 5000
HEX = "0x" + "f" * 5000
BOM = b"\xef\xbb\xbf"
FILES: dict[str, str | bytes] = {
    # scenes
    "digits.toml": f"[tip]\nradius_nm = {DIGITS}\n",
    "hex.toml": f"[tip]\nradius_nm = {HEX}\n",
    "hex_choice.toml": f"[tip]\nshape = {HEX}\n",
    "hex_list.toml": f"[tip]\nradius_nm = [{HEX}]\n",
    "hex_material.toml": f"[tip]\nmaterial = {HEX}\n",
    "deep.toml": f"a = {'[' * 5000}{']' * 5000}\n",
    "deep_tables.toml": f"a = {'{a=' * 2000}1{'}' * 2000}\n",
    "utf16.toml": "[tip]\nradius_nm = 20\n".encode("utf-16"),
    "latin1.toml": "# µ\n[tip]\nradius_nm = 20\n".encode("latin-1"),
    "nul.toml": b"[tip]\0\nradius_nm = 20\n",
    "binary.toml": bytes(range(256)) * 20,
    "empty.toml": b"",
    "large.toml": "#" * (2 << 20) + "\n",
    "prose.toml": "Dear colleague,\n",
    "nan.toml": "[tip]\nradius_nm = nan\n",
    "inf.toml": "[tip]\nradius_nm = inf\n",
    "minus.toml": "[tip]\nradius_nm = -20\n",
    "huge.toml": "[tip]\nradius_nm = 1e999\n",
    "tiny.toml": "[tip]\nradius_nm = 1e-999\n",
    "date.toml": "[tip]\nradius_nm = 2026-01-01\n",
    "text.toml": "[tip]\nradius_nm = '20'\n",
    "yes.toml": "[tip]\nradius_nm = true\n",
    "table.toml": "[tip.radius_nm]\na = 1\n",
    "tables.toml": "[[tip]]\nradius_nm = 20\n",
    "no_table.toml": "tip = 20\n",
    "both.toml": "[tip]\nradius_nm = 20\nradius_m = 2e-8\n",
    "twice.toml": "[tip]\nradius_nm = 20\nradius_nm = 20\n",
    "metres.toml": "[tip]\nradius_m = 20\n",
    "bare.toml": "[tip]\nradius = 20\n",
    "unit.toml": "[tip]\nradius_nN = 20\n",
    "typo.toml": "[tip]\nradus_nm = 20\n",
    "long.toml": f"[tip]\n{'k' * 100_000} = 1\n",
    "line.toml": '["ti\\np"]\na = 1\n',
    "escape.toml": '["\\u001b[31mx"]\na = 1\n',
    "shape.toml": "[tip]\nshape = 'blob'\n",
    "material.toml": "[tip]\nmaterial = 'unobtainium'\n",
    "number.toml": "[sample]\nmaterial = 5\n",
    "poisson.toml": "[sample]\npoisson_ratio = 0.6\n",
    "cold.toml": "[medium]\ntemperature_K = -5\n",
    "humid.toml": "[medium]\nrelative_humidity_percent = 140\n",
    "tail.toml": "[medium]\nrelative_humidity = 0\n[adhesion]\nhamaker_constant_J = 1e-17\n",
    "spring.toml": "[probe]\nspring_constant_N_per_m = 0\n",
    "gains.toml": "[gains]\nrate_Hz = 1e300\n",
    "gain.toml": "[gains]\nforce_gain = nan\n",
    "limit.toml": "[limits]\nforce_N = 0\n",
    "unstable.toml": "[gains]\nforce_gain = 10000\n",
    "budget.toml": "[demand]\nbudget = -1\n",
    "colour.toml": "[demand]\nquantity = 'colour'\n",
    "choice.toml": "[demand]\nquantity = 1.5\n",
    # images, curves, recordings
    "empty.ibw": b"",
    "zeros.ibw": b"\0" * 1000,
    "noise.dat": bytes(range(256)) * 40,
    "noise.ibw": b"\5\0" + bytes(range(256)) * 40,
    "noise.jpk-force": bytes(range(256)) * 40,
    "noise.jpk-force-map": bytes(range(256)) * 40,
    "zip.jpk-force": b"PK\3\4" + b"\xff" * 100,
    "noise.mcap": bytes(range(256)) * 40,
    "magic.mcap": b"\x89MCAP0\r\n",
    "zeros.mcap": b"\x89MCAP0\r\n" + b"\0" * 500,
    "noise.gwy": b"GWYP" + b"\xff" * 300,
    "noise.h5": b"\x89HDF\r\n\x1a\n" + b"\0" * 300,
    "noise.tiff": b"II*\0" + b"\xff" * 100,
    "noise.spm": b"\\*Force file list\r\n\\Version: 0x09\r\n",
    "utf16.txt": "# Width: 1 um\n1 2\n3 4\n".encode("utf-16"),
    "nan.txt": "nan nan\nnan nan\n",
    "prose.txt": "Dear colleague,\n\nthe image will follow tomorrow.\n",
    # tables beside them
    "words.csv": "a,b\n1,2\n",
    "nan.csv": "file,spring_constant\n*.ibw,nan\n",
    "bare.csv": "file,spring_constant\n*.ibw,1.6\n",
    "soft.csv": "file,spring_constant\n*.ibw,1e-9N/m\n",
    "utf16.csv": "file,spring_constant\n*,1N/m\n".encode("utf-16"),
    "wide.csv": f"file,spring_constant\n{'x' * 200_000},1N/m\n",
    "wide_head.csv": f"{'x' * 200_000},spring_constant\n",
    "digits_side.toml": f"[x]\ncontact_point_nm = {DIGITS}\n",
    "hex_side.toml": f"[x]\ncontact_point_nm = {HEX}\n",
    "deep_side.toml": f"x = {'[' * 5000}{']' * 5000}\n",
    "reason_side.toml": "[x]\nexclude = 1\n",
    "order_side.toml": "[x]\nbaseline_nm = [2.0, 1.0]\n",
    "key_side.toml": "[x]\nexcluded = 'crash'\n",
}  # fmt: skip

# every scene is wrong in the same words whoever reads it
SCENES = """
digits.toml         | digits.toml | more digits than can be read
hex.toml            | radius_nm = inf | 0.1 .. 1e+06
hex_choice.toml     | shape | too large int | paraboloid, sphere
hex_list.toml       | radius_nm | too large list | number
hex_material.toml   | material | too large int | silicon
deep.toml           | deep.toml | nested too deep
deep_tables.toml    | deep_tables.toml | nested too deep
utf16.toml          | utf16.toml is not a TOML file
latin1.toml         | latin1.toml is not a TOML file
nul.toml            | nul.toml is not a TOML file
binary.toml         | binary.toml is not a TOML file
empty.toml          | empty.toml: the file is empty
large.toml          | 2048 KiB; TOML files of up to 1024 KiB
prose.toml          | prose.toml is not a TOML file
nan.toml            | radius_nm = nan | 0.1 .. 1e+06
inf.toml            | radius_nm = inf | 0.1 .. 1e+06
minus.toml          | radius_nm = -20 | 0.1 .. 1e+06
huge.toml           | radius_nm = inf | 0.1 .. 1e+06
tiny.toml           | radius_nm = 0 | 0.1 .. 1e+06
date.toml           | radius_nm = datetime.date(2026, 1, 1) | number
text.toml           | radius_nm = '20' | number
yes.toml            | radius_nm = True | number
table.toml          | radius_nm | number
tables.toml         | [tip] must be a table
no_table.toml       | [tip] must be a table of keys, not 20
both.toml           | [tip] has both radius_nm and radius_m
twice.toml          | twice.toml is not a TOML file
metres.toml         | radius_m = 20 | 1e-10 .. 0.001
bare.toml           | radius lacks its unit | radius_nm
unit.toml           | radius_nN | did you mean radius_
typo.toml           | radus_nm | did you mean radius_nm
long.toml           | kkk | half_angle
line.toml           | unknown section [ti\\np] | tip, sample, medium
escape.toml         | unknown section [\\x1b[31mx] | tip, sample, medium
shape.toml          | shape = 'blob' | paraboloid, sphere
material.toml       | 'unobtainium' | silicon, silicon nitride
number.toml         | material | 5 | silicon, silicon nitride
poisson.toml        | poisson_ratio = 0.6 | -0.99 .. 0.5
cold.toml           | temperature_K = -5 | ..
humid.toml          | relative_humidity_percent = 140 | 0 ..
tail.toml           | adhesion.hamaker_constant | = 1e-17 J: valid is 0 .. | works
nowhere.toml        | nowhere.toml: no such file
folder.toml         | folder.toml: this is a folder
pipe.toml           | pipe.toml: this is a device or a pipe
loop.toml           | loop.toml | symbolic links
/dev/zero           | /dev/zero: this is a device
"""

COMMON = """
plan budget.toml                    | [demand] budget = -1 | 0 .. 1e+09
plan colour.toml                    | quantity = 'colour' | force, stiffness, radius, folds
plan choice.toml                    | quantity = 1.5 | force, stiffness, radius, folds
plan silicon-in-air                 | 'silicon-in-air' | did you mean silicon_in_air
plan folder                         | this is a folder
plan ''                             | scene is empty
plan                                | required: SCENE
plan silicon_in_air polyester       | unrecognized arguments: polyester
plan silicon_in_air --relative-accuracy 1e-15    | (--relative-accuracy) = 1e-15 | valid is 1.
plan silicon_in_air --relative-accuracy 60%      | = 0.6 | 0 .. 0.5
plan silicon_in_air --relative-accuracy -1%      | = -0.01 | 0 .. 0.5
plan silicon_in_air --relative-accuracy nan      | 'nan' is not a number
plan silicon_in_air --relative-accuracy 1nm      | the unit 'nm' | percent
plan silicon_in_air --relative-accuracy ''       | relative-accuracy is empty
touch --minimum-margin -1           | '-1' | 0 .. 1e+06
touch --minimum-margin nan          | 'nan' | 0 .. 1e+06
touch --minimum-margin inf          | 'inf' | 0 .. 1e+06
touch --minimum-margin 1,5          | '1,5' | 0 .. 1e+06
touch --minimum-margin 100          | stability margin | 100 is needed
touch --rate -10kHz                 | rate = -10000 Hz | 10 .. 1e+06 Hz
touch --rate 10                     | no unit | kHz
touch --rate 0Hz                    | rate = 0 Hz | 10 .. 1e+06 Hz
touch --rate 10kg                   | the unit 'kg' | kHz
touch --rate nankHz                 | 'nankHz' is not a number
touch --rate 1e300kHz               | rate = 1e+303 Hz | 10 .. 1e+06 Hz
touch --rate 10,5kHz                | ',5kHz' | kHz
touch --delay -1ms                  | --delay -1ms | 0 s or more
touch --delay 1                     | no unit | ms
touch --delay 1e6s                  | delay | ..
touch --force-range x               | --force-range x | -20nN,500nN
touch --force-range 1nN             | --force-range 1nN | -20nN,500nN
touch --force-range -20nN,x         | 'x' | 100nN
touch --force-range nowhere.mcap    | nowhere.mcap
touch --force-range noise.mcap      | noise.mcap
touch --duration 0s                 | --duration 0s | above 0 s, up to 600 s
touch --duration -1s                | --duration -1s | above 0 s, up to 600 s
touch --duration 601s               | --duration 601s | up to 600 s
touch --duration 20                 | no unit | 20s
touch --duration ''                 | duration is empty
touch --duration 100s --rate 1MHz   | 1e+08 steps | up to 6e+06
touch --seed -1                     | '-1' | 0 .. 2^64 - 1
touch --seed 1.5                    | '1.5' | whole number
touch --seed 18446744073709551616   | '18446744073709551616' | 0 .. 2^64 - 1
touch --at 2.5,3                    | --at: '2.5' has no unit | 2.5um
touch --at -1um,0um                 | (-1 um, 0 um) | 0 .. 6 um
touch --at 2.5um                    | 1 lengths instead of 2
touch --at 1um,30um                 | (1 um, 30 um) is outside | 0 .. 6 um
touch --at nanum,0um                | 'nanum' is not a number
touch --line 0um,0um,1um,0um        | --line goes with
touch --mode scan --at 0um,0um      | --at goes with
touch --mode scan --line 0um,0um    | 2 lengths instead of 4
touch --mode scan --line 1um,1um,1um,1um | length
touch --mode scan --line 0um,0um,7um,0um | (7 um, 0 um) is outside | 0 .. 6 um
scan nowhere.ibw                   | nowhere.ibw
scan dots --mode tap               | 'tap' | contact, tapping
scan dots --set-point 20nN         | '20nN'
scan dots --mode contact --set-point 0.7 | no unit
scan dots --mode contact --free-amplitude 20nm | goes with tapping
scan dots --area 0um,0um,1um,1um   | 0.5 um
scan dots --area 1um,2um           | --area
scan dots --pixels 2               | --pixels: '2': valid is a whole number, 4 .. 8192
scan dots --gain 10MHz             | zloop.integral
scan dots --set-point 1.5          | zloop.set_amplitude = 1.5
scan dots --line-rate 0Hz          | raster.line_rate
scan polyester                     | the sample holds the tip
scan cell_in_liquid                | set point
touch --mode hover                  | 'hover' | point, scan
touch --surface moon                | 'moon' | grating, dots, flat, spikes
touch --control mind                | 'mind' | paper, impedance
touch --probe-model rigid           | 'rigid' | quasi-static, dynamic
touch --scene spring.toml           | spring_constant_N_per_m = 0 | 0.0001 .. 10000
touch --scene gains.toml            | rate_Hz = 1e+300 | 10 .. 1e+06
touch --scene gain.toml             | force_gain = nan | ..
touch --scene limit.toml            | force_N = 0 | ..
touch --scene unstable.toml         | stability margin | 1.5
touch --scene ''                    | scene is empty
touch --pixel-size 1nm              | --pixel-size goes with an IMAGE
touch --z-unit nm                   | --z-unit goes with an IMAGE
touch --channel Height              | --channel goes with an IMAGE
touch --untrusted                   | --untrusted
touch prose.txt --surface dots      | not both
touch prose.txt --pixel-size -1nm   | -
touch a b                           | unrecognized arguments: b
touch --duration 1s --out file      | cannot write into file
touch --duration 1s --out ''        | out is empty
touch --out                         | --out: expected one argument
margins --rate -10kHz --no-map      | rate = -10000 Hz | 10 .. 1e+06 Hz
margins --rate 10 --no-map          | no unit | kHz
margins --delay -1us --no-map       | --delay -1us | 0 s or more
margins --path -1um --no-map        | -
margins --path 1 --no-map           | no unit | 2.5um
margins --force-range 5 --no-map    | --force-range 5 | -20nN,500nN
margins --mode hover --no-map       | 'hover' | point, scan
margins gains.toml --no-map         | rate_Hz = 1e+300 | 10 .. 1e+06
margins spring.toml --no-map        | spring_constant_N_per_m = 0 | 0.0001 .. 10000
margins '' --no-map                 | scene is empty
margins noise.mcap                  | noise.mcap
margins magic.mcap                  | magic.mcap
margins nowhere.mcap                | nowhere.mcap
margins nowhere.mcap --rate 1kHz    | holds its own rate
margins --no-map --out file         | cannot write into file
samples --out file/out              | cannot write into file/out
curve --scene ''                    | scene is empty
curve --out file/out                | cannot write into file/out
curve prose.txt                     | unrecognized arguments: prose.txt
export prose.txt --out x.txt        | --out x.txt | .csv, .h5, .hdf5, .tab, .ibw, .gwy or .gsf
export prose.txt --out ''           | .csv, .h5, .hdf5, .tab, .ibw, .gwy or .gsf
export prose.txt                    | required: --out
export nowhere.mcap --out x.csv     | nowhere.mcap: no such file
image                               | required: FILE
image prose.txt --pits              | --pits goes with --grains
image prose.txt --smooth 5          | no unit | 2.5um
image prose.txt --smooth -5nm       | prose.txt
image prose.txt --tip 10            | no unit | 2.5um
image prose.txt --tip 10nm,0.3      | no unit | rad
image prose.txt --tip 10nm,1rad,2   | --tip 10nm,1rad,2 | 10nm,0.3rad
image prose.txt --tip -10nm         | -1e-08 m
image prose.txt --grains 2          | no unit | 2.5um
image prose.txt --pixel-size 10     | no unit | 2.5um
image prose.txt --pixel-size 10s    | the unit 's' | nm
info                                | required: FILE
info a b                            | unrecognized arguments: b
fit prose.txt --model sneddon       | 'sneddon' | hertz, dmt, jkr, maugis
fit prose.txt --branch up           | 'up' | retract, approach
fit prose.txt --index -1            | '-1' | 0 .. 1000000000
fit prose.txt --poisson-ratio 0.6   | '0.6' | -0.99 .. 0.5
fit prose.txt --poisson-ratio nan   | 'nan' | -0.99 .. 0.5
fit prose.txt --known-to weight=3 | 'weight' | sensitivity, spring_constant, radius, thickness, half_angle, correlation
fit prose.txt --known-to radius=x   | 'radius=x' | radius=10
fit prose.txt --known-to half_angle=1 | 'half_angle=1' | half_angle=1deg
fit prose.txt --known-to correlation=-0.8 | 'correlation=-0.8' | as -80 for -0.8
fit prose.txt --spring-constant 8   | --spring-constant: '8' has no unit | N/m
fit prose.txt --spring-constant -8N/m | -8.0 N/m | 0.0001 .. 10000 N/m
fit prose.txt --sensitivity 40nm    | the unit 'nm' | nm/V
fit prose.txt --sensitivity 1m      | has the unit 'm'
fit prose.txt --calibration nowhere | nowhere: no such file
fit prose.txt --calibration words.csv | words.csv: columns a, b | file, spring_constant
fit prose.txt --calibration nan.csv | nan.csv: row 1 | 'nan'
fit prose.txt --calibration bare.csv | bare.csv: row 1 | no unit
fit prose.txt --calibration soft.csv | soft.csv: row 1 | 0.0001 .. 10000 N/m
fit prose.txt --calibration utf16.csv | utf16.csv: not a text file
fit prose.txt --calibration wide.csv | wide.csv: not a table
fit prose.txt --calibration wide_head.csv | wide_head.csv: not a table
fit prose.txt --sidecar key_side.toml | --sidecar goes with a table
fit prose.txt empty.ibw             | results.csv
fit prose.txt noise.dat --out t.csv --sidecar digits_side.toml | digits_side.toml | more digits than can be read
fit prose.txt noise.dat --out t.csv --sidecar hex_side.toml | contact_point_nm | too large int | number
fit prose.txt noise.dat --out t.csv --sidecar deep_side.toml | nested too deep
fit prose.txt noise.dat --out t.csv --sidecar reason_side.toml | exclude is 1 | reason in words
fit prose.txt noise.dat --out t.csv --sidecar order_side.toml | baseline_nm is [2.0, 1.0] | two numbers that grow
fit prose.txt noise.dat --out t.csv --sidecar key_side.toml | expected one or more of | exclude
fit prose.txt noise.dat --out t.csv --compare | --compare looks at one curve
fit prose.txt noise.dat --out t.csv --index 1 | --index picks a curve of one file
fit ''                              | curve is empty
fit                                 | required: CURVE
map prose.txt --threads -1          | '-1' | 0 .. 1024
map prose.txt --threads x           | 'x' | whole number
map prose.txt --model x             | 'x' | hertz, dmt, jkr, maugis
map                                 | required: FILE
reproduce --figure 7                | --figure 7 | 5, 6, 9, 10, 11, 15, 16, 17, 18, 19
reproduce --figure -5               | --figure -5 | 5, 6, 9
reproduce --figure x                | 'x' | int
workflow --pixels 0                 | --pixels 0 | 48 .. 512
workflow --seed -1                  | '-1' | 0 .. 2^32 - 2
workflow --out file                 | cannot write into file
live prose.txt --film new.gif       | prose.txt
live --record file                  | --record file | .mcap
live --film file                    | --film file | .gif, .mp4, .png
live --film nowhere/touch.gif       | --film nowhere/touch.gif | nowhere is not a folder
image prose.txt --grains -2nm       | --grains -2nm | above 0
live --film touch.txt               | --film touch.txt | .gif, .mp4, .png
live prose.txt --radius 30 --film new.gif | 30 | unit
tradeoff --quick --doc x.md         | --doc with --quick
tradeoff --out file                 | cannot write into file
bench --out x.txt                   | --out x.txt | .json
bench --out nowhere/x.json          | nowhere is not a folder
doctor now                          | unrecognized arguments: now
touch --mdoe scan                   | --mdoe | did you mean --mode?
bench --jason                       | bench: error | did you mean --json?
latency --rate 0.5Hz                | 0.5Hz | 1.1 Hz
latency --out wake.txt               | wake.txt | .png
rig check no.toml                    | no.toml | no such file
rig check folder.toml                | folder.toml
review prose.txt                     | required: --sidecar
review nowhere.ibw --sidecar s.toml  | nowhere.ibw: no file
review x.ibw --sidecar s.toml --radius 20 | '20' has no unit
recalibrate x.ibw --lever 1 --lever-known-to 4 --thermal-known-to 3 --out c.csv | no unit
recalibrate x.ibw --lever 1N/m --lever-known-to 4 --thermal-known-to 3 --out c.txt | ending must be .csv
touhc                               | 'touhc' | did you mean touch?
--versoin                           | required: COMMAND
"""

READ_BY = {
    "info": "info {}",
    "image": "image {}",
    "touch": "touch {} --duration 1s",
    "fit": "fit {} --model hertz --radius 20nm",
    "export": "export {} --out x.csv",
}
MEASURED = (
    "empty.ibw", "zeros.ibw", "noise.dat", "noise.ibw", "noise.jpk-force", "zip.jpk-force", "noise.mcap", "magic.mcap",
    "zeros.mcap", "noise.gwy", "noise.h5", "noise.tiff", "noise.spm", "utf16.txt", "nan.txt", "prose.txt",
    "nowhere.ibw", "pipe.txt", "/dev/zero",
)  # fmt: skip


def rows(table: str) -> list[tuple[list[str], list[str]]]:
    """Arguments and the words that the answer must hold."""
    made = []
    for line in table.strip().splitlines():
        command, *words = line.split("|")
        made.append((shlex.split(command), [word.strip() for word in words]))
    return made


CASES: list[tuple[list[str], list[str]]] = rows(COMMON)
for arguments, words in rows(SCENES):
    CASES.append((["plan", *arguments] if arguments[0] != "/dev/zero" else ["margins", *arguments], words))
for arguments, words in rows(SCENES)[::4]:
    CASES += [(["curve", "--scene", *arguments], words), (["touch", "--scene", *arguments], words)]
    CASES += [(["margins", "--no-map", *arguments], words), (["fit", "prose.txt", "--scene", *arguments], [])]
CASES += [(shlex.split(form.format(name)), [name]) for form in READ_BY.values() for name in MEASURED]
CASES += rows("fit folder.txt | results.csv\nreport prose.txt | prose.txt | no folder\nreport nowhere | nowhere")
CASES += [(["touch", "--seed", DIGITS], ["999", "0 .. 2^64 - 1"]), (["plan", "\udcff.toml"], ["no such file"]),
          (["info", "bad\udcff.txt"], ["\\udcff"]), (["plan", "a\nb.toml"], ["a\\nb.toml: no such file"]),
          (["info", "x" * 5000], ["xxx"]), (["fit", "prose.txt", "--groups", "folder"], ["results.csv"])]  # fmt: skip


def make_files(folder: Path) -> None:
    """All the wrong files."""
    for name, content in FILES.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    (folder / "file").write_text("not a folder\n")
    (folder / "bad\udcff.txt").write_text("prose\n")
    for name in ("folder", "folder.toml", "folder.txt"):
        (folder / name).mkdir()
    for name in ("pipe.toml", "pipe.txt"):
        os.mkfifo(folder / name)
    (folder / "loop.toml").symlink_to("loop.toml")
