"""What the importers of published recordings share: arguments, refusals, reading, whole folders.

A script gives `run` its docstring and convert(source, model[, option]), which reads the folder
`source` and returns the files of the experiment, {name: text or bytes}, and one line to say. model is
the path of the robot's MJCF as seen from the experiment's folder. Nothing is written before convert
has returned, and every file appears whole.
"""
import contextlib
import csv
import math
import os
import pathlib
import struct
import sys
import zlib

SCALARS = {1: "b", 2: "B", 3: "h", 4: "H", 5: "i", 6: "I", 7: "f", 9: "d", 12: "q", 13: "Q"}
COMPLEX = 0x800  # a flag of an array
TIME, TURN, PLACE = (1e10, "s"), (1e3, "rad"), (10, "m")  # most that a log has; time also since 1970


class Refusal(Exception):
    """One line for the user."""


def refuse(where, expected, found):
    raise Refusal(f"{where}: expected {expected}, found {found}")


def number(text, where, most=math.inf, unit=""):
    """A finite one, of the size `most` [unit] at most, which a machine can have; where: for the
    message."""
    try:
        value = float(text)
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        refuse(where, "a finite number", repr(text) if text else "nothing")
    if abs(value) > most:
        refuse(where, f"a number of {-most:g} to {most:g} {unit}", text)
    return value


def positive(text, where, most=math.inf, unit=""):
    value = number(text, where, most, unit)
    if value <= 0:
        refuse(where, "a positive number", text)
    return value


def rise(times):
    """Refuses a time that is not after the one before it; times: (where, number)."""
    last = -math.inf
    for where, time in times:
        if time <= last:
            refuse(where, f"a time after {last:g}", f"{time:g}")
        last = time


def read_table(path, columns, least=2):
    """The header of a CSV and its rows, (where, {column: text}); each of `columns` is there once."""
    rows = []
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            lines = csv.reader(file)
            header = next(lines, [])
            for column in columns:
                if header.count(column) != 1:
                    often = "two of it" if column in header else ", ".join(header) or "nothing"
                    refuse(f"{path}:1", f"a column '{column}'", often)
            for cells in lines:
                where = f"{path}:{lines.line_num}"
                if len(cells) != len(header):
                    refuse(where, f"{len(header)} cells", len(cells))
                rows.append((where, dict(zip(header, cells))))
    except (UnicodeDecodeError, csv.Error) as error:
        refuse(path, "a table as CSV", error)
    if len(rows) < least:
        refuse(path, f"at least {least} rows", len(rows))
    return header, rows


def elements(data, at=0):
    """(type, bytes) of the elements of a MAT file from an offset on."""
    while at + 8 <= len(data):
        kind, size = struct.unpack_from("<II", data, at)
        if kind >> 16:  # up to four bytes in the tag itself
            yield kind & 0xFFFF, data[at + 4:at + 4 + (kind >> 16)]
            at += 8
        else:
            yield kind, data[at + 8:at + 8 + size]
            at += 8 + size + (0 if kind == 15 else -size % 8)


def matrix(part):
    """(name, rows, columns, numbers by columns) of a real matrix."""
    parts = list(elements(part))
    if struct.unpack_from("<I", parts[0][1])[0] & COMPLEX:
        raise LookupError("complex numbers")
    rows, columns = struct.unpack("<2i", parts[1][1])
    kind, data = parts[3]
    return (parts[2][1].decode("ascii"), rows, columns,
            struct.unpack(f"<{rows * columns}{SCALARS[kind]}", data))


def read_mat(path, expected):
    """Matrices of a little-endian MATLAB file of version 5; expected: in words, for the message."""
    data, found = path.read_bytes(), []
    try:
        for kind, part in elements(data, 128):
            if kind == 15:
                kind, part = next(elements(zlib.decompress(part)))
            if kind == 14:
                found.append(matrix(part))
    except (struct.error, zlib.error, LookupError, StopIteration, UnicodeDecodeError):
        refuse(path, expected, "a damaged or another one")
    if not found:
        refuse(path, expected, "no matrix")
    return found


def write_folder(target, files):
    """Each file by way of one beside it, so that none is ever seen in part."""
    new = not target.exists()
    target.mkdir(parents=True, exist_ok=True)
    parts = {target / f".{name}.part": target / name for name in files}
    try:
        for part, content in zip(parts, files.values()):
            part.write_bytes(content if isinstance(content, bytes) else content.encode())
        for part, path in parts.items():
            os.replace(part, path)
    except BaseException:
        for part in parts:
            with contextlib.suppress(OSError):
                part.unlink()
        if new:
            with contextlib.suppress(OSError):
                target.rmdir()
        raise


def convert_folders(arguments, script, convert, option, read_option):
    usage = "SOURCE_FOLDER EXPERIMENT_FOLDER" + (f" [{option}]" if option else "")
    if not 2 <= len(arguments) <= (3 if option else 2):
        raise Refusal(f"expected {usage}, found {len(arguments)} "
                      f"argument{'' if len(arguments) == 1 else 's'}")
    source, target = map(pathlib.Path, arguments[:2])
    if target.exists() and not target.is_dir():
        refuse(target, "a folder to write to", "a file")
    if source.resolve() == target.resolve():
        refuse(target, "a folder other than the source", "the same")
    folder = script.resolve().parent
    model = os.path.relpath(folder / f"{folder.name}.xml", target.resolve())
    files, said = convert(source, model, *map(read_option, arguments[2:]))
    write_folder(target, files)
    print(f"{said} in {target}")


def attempt(name, job):
    """Runs a script's job; what it refuses is one line that begins with the script's name."""
    try:
        job()
    except Refusal as refusal:
        print(f"{name}: {refusal}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"{name}: {error.filename}: {error.strerror}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print(f"{name}: interrupted, nothing written", file=sys.stderr)
        sys.exit(130)


def run(file, doc, convert, option="", read_option=None):
    """A script from its command line; option: a third argument that may be given, and its
    reader."""
    script, arguments = pathlib.Path(file), sys.argv[1:]
    if "-h" in arguments or "--help" in arguments:
        print(doc.strip())
        return
    attempt(script.name,
            lambda: convert_folders(arguments, script, convert, option, read_option))
