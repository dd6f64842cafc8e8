#!/usr/bin/env python3
"""Plants one-line faults in a copy of the sources and reports which of them the tests find.

    tests/mutation/mutate.py --folder /tmp/mutation --count 60 --seed 1
    tests/mutation/mutate.py --folder /tmp/mutation --room gap --count 15 --seed 2 --resume

It never edits the tree it lies in: the files that git knows there, and new ones, are copied to
FOLDER/tree0 (tree1 ...; one for each of --jobs) and built there. A fault is found when a test program
of its room, or of a room that uses it (TESTS below), fails or takes more than three times its time.
The tests of a program that take longer than LONG_S are run after its others.
Faults that do not compile do not count and are drawn anew. Every outcome is a line of
FOLDER/outcomes.jsonl; --resume goes on after the last.
"""

import argparse
import concurrent.futures
import contextlib
import dataclasses
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]

# The test programs that are run for a fault in a room, the nearest first; the first to fail ends it.
TESTS = {
    "limits": ["limits", "trajectory", "commands"],
    "statistics": ["statistics", "gap", "sweep", "report"],
    "files": ["files", "trajectory", "sweep", "commands"],
    "geometry": ["geometry", "gap", "simulation"],
    "yaml": ["yaml", "experiment", "commands"],
    "terminal": ["terminal", "commands"],
    "trajectory": ["trajectory", "gap", "commands"],
    "control": ["control", "trial", "identification"],
    "trial": ["trial", "simulation", "hardware"],
    "gap": ["gap", "report", "commands"],
    "odometry": ["odometry", "hardware", "commands"],
    "search": ["search", "sweep"],
    "simulation": ["simulation", "twin", "identification", "commands"],
    "vision": ["vision", "track", "commands"],
    "hardware": ["hardware", "firmware", "drive", "twin"],
    "firmware": ["firmware"],
    "twin": ["twin", "track", "drive"],
    "experiment": ["experiment", "yaml", "commands"],
    "sweep": ["sweep", "report", "commands", "identification"],
    "report": ["report", "commands", "drive", "track"],
    "view": ["view", "track", "commands"],
    "flags": ["flags", "commands"],
    "sessions": ["sessions", "camera_sessions", "drive", "track", "twin", "commands"],
    "commands": ["commands", "drive", "track", "twin"],
}

# Those of which a second program holds the tests that need OpenCV's files (rift_room_test()).
SLOW_START = {"vision", "view", "track", "drive", "twin", "camera_sessions"}

LONG_S = 5.0

# Words whose exchange is a likely slip. Whole words, and parts of names such as gap_x_m or LeftWheel.
PAIRS = [
    ("left", "right"), ("Left", "Right"), ("roll", "pitch"), ("simulated", "reference"),
    ("Simulated", "Reference"), ("sim", "real"), ("first", "last"), ("front", "back"),
    ("before", "after"), ("low", "high"), ("lower", "upper"), ("minimum", "maximum"),
    ("min", "max"), ("Min", "Max"), ("sin", "cos"), ("floor", "ceil"), ("row", "column"),
    ("rows", "cols"), ("width", "height"), ("mean", "sd"), ("start", "end"), ("begin", "end"),
    ("passed", "failed"), ("above", "repeats"), ("x_m", "y_m"), ("x", "y"), ("median", "mean"),
    ("any_of", "all_of"), ("upper_bound", "lower_bound"), ("min_element", "max_element"),
]
SWAPS = {}
for one, other in PAIRS:
    SWAPS.setdefault(one, other)
    SWAPS.setdefault(other, one)

EXCHANGES = {  # an operator between blanks and what it becomes
    "<": ["<=", ">"], "<=": ["<", ">="], ">": [">=", "<"], ">=": [">", "<="], "==": ["!="],
    "!=": ["=="], "&&": ["||"], "||": ["&&"], "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"],
    "+=": ["-="], "-=": ["+="], "%": ["/"], "<<": [">>"], "&": ["|"],
    "and": ["or"], "or": ["and"], "is": ["is not"],
}


@dataclasses.dataclass(frozen=True)
class Fault:
    path: str
    line: int  # from 1
    operator: str
    old: str
    new: str

    @property
    def room(self):
        return self.path.split("/")[1] if self.path.count("/") > 1 else "commands"

    @property
    def key(self):
        return hashlib.sha256(f"{self.path}:{self.line}:{self.new}".encode()).hexdigest()[:10]


def masked(text, is_python):
    """`text` with comments and the inside of strings as blanks, at the same length."""
    if is_python:
        pattern = r'""".*?"""|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|#[^\n]*'
    else:
        pattern = (r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|//[^\n]*|/\*.*?\*/'
                   r'|^[ ]*#[^\n]*')
    return re.sub(pattern, lambda m: re.sub(r"[^\n]", "\x01", m.group()), text,
                  flags=re.DOTALL | re.MULTILINE)


def other_number(text):
    if re.fullmatch(r"\d+", text):
        return [str(int(text) + 1)] + ([str(int(text) - 1)] if int(text) > 0 else [])
    value = float(text)
    return [repr(value * 2) if value else "0.5", repr(value * 0.9) if value else "-0.5"]


def changes_of_line(code):
    """(operator, begin, end, new text) of every fault of a masked line."""
    for m in re.finditer(r"(?<= )(<=|>=|==|!=|&&|\|\||\+=|-=|<<|[-<>+*/%&]|and|or|is)(?= )", code):
        for new in EXCHANGES[m.group()]:
            yield "operator", m.start(), m.end(), new
    for m in re.finditer(r"(?<![\w.])(\d+\.\d*(?:e-?\d+)?|\d+e-?\d+|\d+)(?![\w.\x01])", code):
        for new in other_number(m.group()):
            yield "constant", m.start(), m.end(), new
    for m in re.finditer(r"(?<![=!<>\w])!(?=[\w(])|\bnot (?!in\b)", code):
        yield "not dropped", m.start(), m.end(), ""
    for m in re.finditer(r"(?<=[(=,] )-(?=[\w(])|(?<=return )-(?=[\w(])|(?<=\()-(?=[\w(])", code):
        yield "sign", m.start(), m.end(), ""
    for m in re.finditer(r"\+\+|--", code):
        yield "step", m.start(), m.end(), "--" if m.group() == "++" else "++"
    for m in re.finditer(r"\b(true|false|True|False|break|continue)\b", code):
        new = {"true": "false", "false": "true", "True": "False", "False": "True",
               "break": "continue", "continue": "break"}[m.group()]
        yield "constant", m.start(), m.end(), new
    for m in re.finditer(r"[A-Za-z]\w*", code):
        yield from swapped_names(m)
    for m in re.finditer(r"(?<=\w)\(([\w.\->:*]+(?:\[\w+\])?), ([\w.\->:*]+(?:\[\w+\])?)\)", code):
        yield "argument swap", m.start(), m.end(), f"({m[2]}, {m[1]})"
    for m in re.finditer(r"\[(\w+)\]\[(\w+)\]", code):
        yield "index swap", m.start(), m.end(), f"[{m[2]}][{m[1]}]"
    for m in re.finditer(r"\.size\(\)(?! - 1)", code):
        yield "off by one", m.end(), m.end(), " - 1"
    m = re.match(r"( +)(?:else )?if \((.*)\) (return\b.*|continue|break);$", code)
    if m:
        yield "guard dropped", m.start(), len(code), m[1] + ";"
    m = re.match(r"( +)if \((.*)\)( \{| .*;)$", code)
    if m and "=" not in re.sub(r"[=!<>]=", "", m[2]) and ";" not in m[2]:
        yield "condition", m.start(2), m.end(2), f"!({m[2]})"
    m = re.match(r"( +)if (.*):$", code)
    if m:
        yield "condition", m.start(2), m.end(2), f"not ({m[2]})"
    m = re.match(r"( +)[\w.\->\[\]*:]+(?:\(.*\)| [-+*/|]?= .*);$", code)
    if m and not re.match(r" +(return|using|const|auto|throw|case|friend|explicit|static)\b", code):
        yield "statement deleted", m.start(), len(code), m[1] + ";"
    m = re.match(r"( +)self\.[\w.]+(?:\(.*\)| [-+*/|]?= .*)$", code)
    if m:
        yield "statement deleted", m.start(), len(code), m[1] + "pass"


def swapped_names(m):
    name = m.group()
    if name in SWAPS:
        yield "name swap", m.start(), m.end(), SWAPS[name]
        return
    for old, new in SWAPS.items():
        if len(old) < 3 and old not in ("x", "y"):
            continue
        parts = [rf"(?<![a-z]){old}(?=_|\d|$)"] if old.islower() else [rf"{old}(?![a-z])"]
        changed = re.sub(parts[0], new, name)
        if changed != name:
            yield "name swap", m.start(), m.end(), changed


def faults_of(root, path):
    text = (root / path).read_text(encoding="utf-8")
    lines = text.split("\n")
    code_lines = masked(text, path.endswith(".py")).split("\n")
    skip = re.compile(r"^\s*(#|namespace|using|template|class|struct|enum|static_assert|import|from)\b")
    seen = set()
    for number, (line, code) in enumerate(zip(lines, code_lines), 1):
        if skip.match(code):
            continue
        for operator, begin, end, new in changes_of_line(code):
            changed = line[:begin] + new + line[end:]
            if "\x01" in new:  # it spans a string: take the text as it stands
                piece = list(new)
                source = [c for c, k in zip(line[begin:end], code[begin:end]) if k == "\x01"]
                changed = line[:begin] + "".join(
                    source.pop(0) if c == "\x01" and source else c for c in piece) + line[end:]
            if changed != line and (number, changed) not in seen:
                seen.add((number, changed))
                yield Fault(path, number, operator, line, changed)


def all_faults(root, rooms):
    files = sorted(str(p.relative_to(root)) for p in (root / "src").rglob("*")
                   if p.suffix in (".cpp", ".hpp", ".py") and "assets" not in p.parts)
    for path in files:
        for fault in faults_of(root, path):
            if not rooms or fault.room in rooms:
                yield fault


def drawn(faults, seed):
    """All faults in the order in which they are tried: rooms in turn by lines, at most one of a line."""
    generator = random.Random(seed)
    generator.shuffle(faults)
    lines = set()
    for fault in faults:
        if (fault.path, fault.line) not in lines:
            lines.add((fault.path, fault.line))
            yield fault


RUNNING = set()  # process groups, one for each job


def end_all(*_):
    """What is told to end leaves nothing running; a fault that was planted stays in its copy."""
    for group in list(RUNNING):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(group, signal.SIGKILL)
    os._exit(1)


def run(command, cwd, timeout_s, log):
    """Exit code, or None after `timeout_s`; the process and its children are ended then."""
    with open(log, "ab") as out:
        process = subprocess.Popen(command, cwd=cwd, stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                                   start_new_session=True)
        RUNNING.add(process.pid)
        try:
            return process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return None
        finally:
            RUNNING.discard(process.pid)


def copy_tree(tree):
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "-z"], cwd=ROOT, check=True,
                           capture_output=True).stdout.decode().split("\0")
    wanted = {n for n in names if n and (ROOT / n).is_file()}
    for name in wanted:
        source, target = ROOT / name, tree / name
        same = target.exists() and target.read_bytes() == source.read_bytes()
        if not same:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)
            os.utime(target)
    for folder in ("src", "include", "tests"):
        for path in (tree / folder).rglob("*"):
            if path.is_file() and str(path.relative_to(tree)) not in wanted:
                path.unlink()


def targets_of(rooms):
    return [f"rift_{t}_test" for t in rooms]  # those that run the binary depend on it


def build(tree, tests, log, cores):
    return run(["ninja", "-C", "build", "-j", str(cores), *targets_of(tests)], tree, 3600, log)


def prepare(tree, tests, cores):
    """Copies, configures and builds; the time in seconds that each test program takes."""
    tree.mkdir(parents=True, exist_ok=True)
    copy_tree(tree)
    log = tree.parent / f"{tree.name}.log"
    if run(["cmake", "--preset", "ci", "-DRIFT_BUILD_TESTS=ON"], tree, 600, log) != 0:
        sys.exit(f"{tree} cannot be configured: {log}")
    if build(tree, tests, log, cores) != 0:
        sys.exit(f"{tree} does not build without a fault: {log}")


def program(tree, test):
    return str(tree / "build" / "tests" / f"rift_{test}_test")


def baseline(tree, test):
    """The parts of a test program in the order they are run: (filter of Catch2, seconds)."""
    log = tree.parent / f"{tree.name}.{test}.log"
    log.write_bytes(b"")
    if run([program(tree, test), "--durations", "yes"], tree / "build", 1800, log) != 0:
        sys.exit(f"the tests of {test} fail without a fault: {log}")
    names = subprocess.run([program(tree, test), "--list-test-names-only"], check=False,
                           capture_output=True, text=True).stdout.splitlines()
    return parts_of(log.read_text(errors="replace"), [n for n in names if n])


def parts_of(durations, names):
    times = dict.fromkeys(names, 0.0)
    for seconds, name in re.findall(r"^([\d.]+) s: (.*)$", durations, flags=re.MULTILINE):
        if name in times:
            times[name] = max(times[name], float(seconds))
    halves = [[n for n in names if times[n] <= LONG_S], [n for n in names if times[n] > LONG_S]]
    return [(",".join(re.sub(r"([\\,\[])", r"\\\1", n) for n in half), sum(times[n] for n in half))
            for half in halves if half]


def failed_test(log):
    text = pathlib.Path(log).read_text(errors="replace")
    found = re.search(r"^-{70,}\n(.+?)\n(?:.*\n)*?-{70,}", text, flags=re.MULTILINE)
    return found[1].strip() if found else ""


def tests_of(room, most):
    near = TESTS.get(room, ["commands"])[:most]
    return [name for test in near
            for name in ([test, f"{test}_slow_start"] if test in SLOW_START else [test])]


def try_fault(tree, fault, tests, parts):
    """The outcome of one fault: `found` by a test, `survived` or `does not compile`."""
    path = tree / fault.path
    good = path.read_text(encoding="utf-8")
    lines = good.split("\n")
    assert lines[fault.line - 1] == fault.old
    lines[fault.line - 1] = fault.new
    log = tree.parent / f"{tree.name}.fault.log"
    log.write_bytes(b"")
    outcome = {**dataclasses.asdict(fault), "room": fault.room, "key": fault.key}
    try:
        path.write_text("\n".join(lines), encoding="utf-8")
        for test in tests:
            log.write_bytes(b"")
            if build(tree, [test], log, 1) != 0:
                return {**outcome, "status": "does not compile"}
            for names, seconds in parts[test]:
                code = run([program(tree, test), "--abort", names], tree / "build", 30 + 3 * seconds, log)
                if code != 0:
                    name = "no end" if code is None else failed_test(log)
                    return {**outcome, "status": "found", "by": test, "test": name}
        return {**outcome, "status": "survived"}
    finally:
        path.write_text(good, encoding="utf-8")


class Run:
    """The faults of one call, handed out one by one, and their outcomes."""

    def __init__(self, journal, faults, count, end_s):
        self.outcomes = [json.loads(l) for l in journal.read_text().splitlines()] if journal.exists() else []
        asked = {f.key for f in faults}
        done = {o["key"] for o in self.outcomes}
        self.left = count - sum(o["key"] in asked and counts(o) for o in self.outcomes)
        self.queue = iter([f for f in faults if f.key not in done])
        self.end_s = end_s
        self.lock = threading.Lock()
        self.file = open(journal, "a", encoding="utf-8")

    def next(self):
        """The next fault; none when enough are tried or under way."""
        with self.lock:
            if self.left <= 0 or time.monotonic() > self.end_s:
                return None
            self.left -= 1
            return next(self.queue, None)

    def note(self, outcome):
        with self.lock:
            self.left += not counts(outcome)
            self.outcomes.append(outcome)
            self.file.write(json.dumps(outcome) + "\n")
            self.file.flush()
            print(f"{outcome['status']:<17}{outcome['path']}:{outcome['line']} {outcome['operator']}",
                  flush=True)

    def work(self, tree, programs, parts):
        while (fault := self.next()) is not None:
            self.note(try_fault(tree, fault, tests_of(fault.room, programs), parts))


def counts(outcome):
    return outcome["status"] != "does not compile"


def table(outcomes):
    rooms = {}
    for one in outcomes:
        if counts(one):
            rooms.setdefault(one["room"], []).append(one["status"] == "found")
    lines = [f"{'room':<12} found  of"]
    for room, found in sorted(rooms.items()):
        lines.append(f"{room:<12} {sum(found):>5} {len(found):>3}")
    everything = [f for found in rooms.values() for f in found]
    lines.append(f"{'all':<12} {sum(everything):>5} {len(everything):>3}")
    return "\n".join(lines)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--folder", required=True, type=pathlib.Path, help="for the copies and outcomes")
    parser.add_argument("--count", type=int, default=20, help="faults that compile (default 20)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--room", action="append", choices=sorted(TESTS), help="of these rooms only")
    parser.add_argument("--programs", type=int, default=9,
                        help="most test programs that are run for a fault, the nearest first")
    parser.add_argument("--jobs", type=int, default=2, help="faults at a time, each in its own copy")
    parser.add_argument("--resume", action="store_true", help="go on with outcomes.jsonl")
    parser.add_argument("--minutes", type=float, help="stop after so long; --resume goes on")
    parser.add_argument("--list", action="store_true", help="print the faults and plant none")
    return parser.parse_args()


def main():
    args = arguments()
    for stop in (signal.SIGINT, signal.SIGTERM):
        signal.signal(stop, end_all)
    order = list(drawn(list(all_faults(ROOT, args.room)), args.seed))
    if args.list:
        for fault in order[:args.count]:
            print(f"{fault.path}:{fault.line}: {fault.operator}\n- {fault.old}\n+ {fault.new}")
        return 0
    folder = args.folder.resolve()
    if ROOT == folder or ROOT in folder.parents:
        sys.exit("--folder is inside this tree: give one outside")
    journal = folder / "outcomes.jsonl"
    if journal.exists() and not args.resume:
        sys.exit(f"{journal} exists: --resume goes on with it")
    tests = list(dict.fromkeys(t for f in order for t in tests_of(f.room, args.programs)))
    trees = [folder / f"tree{i}" for i in range(args.jobs)]
    for tree in trees:
        prepare(tree, tests, args.jobs)
    kept = folder / "baseline.json"
    parts = json.loads(kept.read_text()) if args.resume and kept.exists() else {}
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        untimed = [t for t in tests if t not in parts]
        parts.update(zip(untimed, pool.map(lambda t: baseline(trees[0], t), untimed)))
    kept.write_text(json.dumps(parts, indent=1) + "\n")
    end_s = time.monotonic() + 60 * args.minutes if args.minutes else float("inf")
    tried = Run(journal, order, args.count, end_s)
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for worker in [pool.submit(tried.work, tree, args.programs, parts) for tree in trees]:
            worker.result()
    outcomes = tried.outcomes
    for one in outcomes:
        if one["status"] == "survived":
            print(f"\n{one['path']}:{one['line']}: {one['operator']}\n- {one['old']}\n+ {one['new']}")
    print("\n" + table(outcomes))
    return 0


if __name__ == "__main__":
    sys.exit(main())
