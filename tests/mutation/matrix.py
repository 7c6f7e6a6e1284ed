# SPDX-License-Identifier: Apache-2.0
"""Which case notices which mutant: tests/mutation/run --matrix. What it writes is read by tests/mutation/sweep.

A first pass of each program without a mutant says of every case which mutants it comes to, and how long it takes. Then every mutant is put before
all cases that come to it, none of which stops the others. Of what it has seen each line is kept beside the table (FILE.journal): a run that
was broken off goes on there, and one of other programs adds to it.
"""
import concurrent.futures
import os
import re
import resource
import select
import signal
import subprocess
import tempfile
import threading
import time
from pathlib import Path

# The layers of tests, by folder: what asks something of another kind. The first that fits.
LAYERS = [
    ("tests/judged/", "judged"), ("tests/long_day/", "judged"), ("tests/fuzz/", "judged"),
    ("tests/obey/", "obey"), ("tests/golden/", "golden"),
    ("tests/profiles/", "files"), ("tests/config/", "files"), ("tests/docs/", "files"),
    ("tests/integration/", "story"), ("tests/vcan/", "story"), ("tests/dds_process/", "story"),
    ("tests/", "unit"),
]
# Minutes for each mutant: only if they are asked for by name.
DEAR = re.compile(r"judged|long_day")
# What is read once for all cases of a program: only the first one comes to it, and each fails by it.
READ_ONCE = ("gateway/profile/", "gateway/model/")
BODY = re.compile(r"^(?:TEST|TEST_F|TEST_P|TYPED_TEST)\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
RUN = re.compile(rb"^\[ RUN      \] (\S+)")
END = re.compile(rb"^\[(       OK|  FAILED |  SKIPPED) \] ([^\s,]+)(?:, where .*)? \((\d+) ms\)")


def layer_of(path):
    return next(layer for folder, layer in LAYERS if path.startswith(folder))


def body_of(case):
    """"Suite.Name" of what gtest calls "Instance/Suite.Name/Parameter"."""
    suite, _, name = case.partition(".")
    return f"{suite.split('/')[1] if '/' in suite and not suite.split('/')[1].isdigit() else suite.split('/')[0]}.{name.split('/')[0]}"


def bodies(path, text):
    """Of each TEST its "Suite.Name" and how many lines it has."""
    found = {}
    for match in BODY.finditer(text):
        closing = re.compile(r"^\}", re.MULTILINE).search(text, match.end())
        line = text[match.start():text.find("\n", match.start())]
        end = match.start() + len(line) if line.rstrip().endswith("}") and line.count("{") == line.count("}") else (closing or end).end()
        found[f"{match[1]}.{match[2]}"] = (path, text.count("\n", match.start(), end) + 1)
    return found


def sources(root):
    """Of each folder of tests its TESTs."""
    found = {}
    for path in sorted((root / "tests").rglob("*.cpp")):
        name = str(path.relative_to(root))
        found.setdefault(str(Path(name).parent), {}).update(bodies(name, path.read_text()))
    return found


def progress(line, running):
    """What a line of GoogleTest says: the case that runs now, and the one that ended, how, and after how many seconds."""
    if match := RUN.match(line):
        return match[1].decode(), None
    if match := END.match(line):
        return None, (match[2].decode(), match[1] == b"  FAILED ", int(match[3]) / 1000)
    return running, None


def used(pid):
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    except OSError:
        return 0.0


def once(program, number, cases, limit_of, enough, reached=None):
    """One process with these cases: {case: (failed, seconds)} of those that ended, the one that it did not survive and how."""
    env = dict(os.environ, AXISGATE_MUTANT=str(number))
    if reached:
        env["AXISGATE_MUTANTS_REACHED"] = str(reached)
    ended, running, how, failures, rest = {}, None, "", 0, b""
    with tempfile.NamedTemporaryFile("w", prefix="axisgate-matrix-", suffix=".flags") as flags:
        flags.write("--gtest_filter=" + ":".join(cases) + "\n")
        if enough:  # of many the order of the sources would choose always the same
            flags.write(f"--gtest_shuffle\n--gtest_random_seed={number}\n")
        flags.flush()
        process = subprocess.Popen(["nice", str(program.path), f"--gtest_flagfile={flags.name}", "--gtest_color=no"], env=env, cwd=program.path.parent,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)))
        since, before = time.monotonic(), 0.0
        with process.stdout as out:
            while True:
                ready, _, _ = select.select([out], [], [], 0.2)
                if ready:
                    read = os.read(out.fileno(), 1 << 16)
                    if not read:
                        break
                    *lines, rest = (rest + read).split(b"\n")
                    for line in lines:
                        running, done = progress(line, running)
                        if done:
                            ended[done[0]] = done[1:]
                            failures += done[1]
                        if done or RUN.match(line):
                            since, before = time.monotonic(), used(process.pid)
                    if enough and failures >= enough:
                        how = "enough"
                        process.kill()
                        break
                limit = limit_of(running)
                if used(process.pid) - before > limit or time.monotonic() - since > 10 * limit:
                    how = "hang"
                    process.kill()
                    break
        code = process.wait()
    if how == "enough":
        return ended, None, how
    if code < 0 or how == "hang":
        return ended, running or "*", how or ("hang" if code == -signal.SIGXCPU else "crash")
    if code not in (0, 1):
        return ended, running or "*", "crash"
    return ended, None, ""


class Cases:
    """One program, its cases, what each comes to and how long it takes."""

    def __init__(self, program):
        self.program, self.seconds, self.reached, self.everywhere = program, {}, {}, set()

    def look(self, file, again=False):
        """Without a mutant; kept in the file as long as the program is the same."""
        if not file.exists() or (again and file.stat().st_mtime < self.program.path.stat().st_mtime):
            marks = file.with_suffix(".marks")
            marks.unlink(missing_ok=True)
            unlimited = lambda _: 600
            for reached in (marks, None):  # the second time is that of the case, without the marks
                ended, dead, how = once(self.program, 0, ["*"], unlimited, 0, reached)
                if wrong := [case for case, (failed, _) in ended.items() if failed] + ([dead] if dead else []):
                    raise SystemExit(f"tests/mutation/run: without a mutant, {wrong[0]} of {self.program.name} fails {how}")
            came = {}
            for line in marks.read_text().splitlines() if marks.exists() else []:
                case, *numbers = line.split()
                came.setdefault(case, set()).update(numbers)
            rows = {case: (seconds, came.get(case, set())) for case, (_, seconds) in ended.items()}
            rows["*"] = (0, came.get("*", set()))
            file.write_text("".join(f"{case}\t{seconds}\t{' '.join(sorted(numbers, key=int))}\n" for case, (seconds, numbers) in rows.items()))
        for line in file.read_text().splitlines():
            case, seconds, numbers = line.split("\t")
            self.seconds[case], self.reached[case] = float(seconds), {int(n) for n in numbers.split()}
        self.everywhere = self.reached.pop("*")
        del self.seconds["*"]

    def coming_to(self, mutant, slowest):
        """The cases that come to it, the dear ones left out."""
        come = [case for case, numbers in self.reached.items() if mutant.number in numbers]
        if mutant.number in self.everywhere or (come and mutant.path.startswith(READ_ONCE)):
            come = list(self.reached)
        return [case for case in come if self.seconds[case] <= slowest]

    def play(self, number, cases, enough):
        """Those that fail for it: {case: how}. One that ends the process does not keep the others from running."""
        failed, rest = {}, list(cases)
        limit_of = lambda case: 5 + 10 * self.seconds.get(case, 0.0)
        while rest:
            ended, dead, how = once(self.program, number, rest, limit_of, enough and enough - len(failed))
            failed.update({case: "" for case, (wrong, _) in ended.items() if wrong})
            if dead == "*":  # not in a case: as if each failed
                failed.update({case: how for case in rest if case not in ended})
                break
            if dead:
                failed[dead] = how
            left = [case for case in rest if case not in ended and case != dead]
            if how == "enough" or not dead or len(left) == len(rest) or (enough and len(failed) >= enough):
                break
            rest = left
        return failed


class Matrix:
    """What has been seen so far, in FILE.journal, and the table that is made of it."""

    def __init__(self, file, root, slowest):
        self.slowest = slowest
        self.file, self.journal = file, Path(f"{file}.journal")
        self.root, self.lock, self.written = root, threading.Lock(), 0.0
        self.seen, self.programs = {}, {}  # (mutant, program): failed cases; program: Cases
        for line in self.journal.read_text().splitlines() if self.journal.exists() else []:
            number, program, enough, failed = line.split("\t")
            self.seen[int(number), program] = (int(enough), dict(part.partition("!")[::2] for part in failed.split()))

    def add(self, number, program, enough, failed):
        with self.lock:
            self.seen[number, program] = (enough, failed)
            with self.journal.open("a") as out:
                told = " ".join(case + (f"!{how}" if how else "") for case, how in failed.items())
                out.write(f"{number}\t{program}\t{enough}\t{told}\n")
            if time.monotonic() - self.written > 30:
                self.write()

    def write(self):
        self.file.write_text(table(self.programs, self.seen, sources(self.root), self.slowest))
        self.written = time.monotonic()


def table(programs, seen, tests, slowest):
    """A line each: of a program how far it is played; of a TEST that comes to a mutant its cost, to how many it comes, and those that it
    notices ("-": it is too slow and was left out)."""
    out = ["# Which test notices which mutant (tests/mutation/README.md), made by tests/mutation/run --matrix and read by tests/mutation/sweep.",
           "#\tcase\tlayer\tseconds\tlines\tcases\tmutants it comes to\tmutants it notices"]
    for name, cases in sorted(programs.items()):
        folder = str(cases.program.path.parent).partition("/build/dev/")[2]
        known, unknown = tests.get(folder, {}), (folder, 0)
        if not any(program == name for _, program in seen):
            continue
        come = set().union(*cases.reached.values(), cases.everywhere)
        played = {number: failed for (number, program), failed in seen.items() if program == name and number in come}
        enough = max([most for most, _ in played.values()], default=0)
        out.append(f"program\t{name}\t{folder}\tplayed {len(played)} of {len(come)}" + (f", until {enough} cases fail" if enough else ""))
        rows = {}
        for case, numbers in cases.reached.items():
            row = rows.setdefault(body_of(case), [0.0, 0, set(), set(), False])
            row[0], row[1], row[4] = row[0] + cases.seconds[case], row[1] + 1, row[4] or cases.seconds[case] > slowest
            row[2] |= numbers
        for number, (_, failed) in played.items():
            for case in failed:
                if body_of(case) in rows:
                    rows[body_of(case)][3].add(number)
        file = ""
        for case in sorted(rows, key=lambda body: (known.get(body, unknown)[0], body)):
            seconds, count, came, notices, left_out = rows[case]
            if not came and not notices and not left_out:
                continue  # nothing is known by it
            path, lines = known.get(case, unknown)
            if path != file:
                out.append(f"file\t{path}")
                file = path
            out.append(f"{case}\t{layer_of(path + '/')}\t{seconds:.3f}\t{lines}\t{count}\t{len(came)}\t{' '.join(map(str, sorted(notices)))}{' -' if left_out else ''}")
    return "\n".join(out) + "\n"


def fill(matrix, programs, wanted, mutants, slowest, enough, jobs, scratch):
    """Every mutant before every case of the wanted programs that comes to it, as far as it has not been."""
    for program in programs:
        file = scratch / f"build/{program.name}.cases"
        if wanted(program) or file.exists():
            matrix.programs[program.name] = Cases(program)
            matrix.programs[program.name].look(file, again=wanted(program))
    work = []
    for mutant in mutants:
        for name, cases in matrix.programs.items():
            if not wanted(cases.program):
                continue
            coming = cases.coming_to(mutant, slowest)
            if coming and (mutant.number, name) not in matrix.seen:
                work.append((mutant, cases, coming))
    cost = sum(cases.seconds[case] for _, cases, coming in work for case in coming)
    print(f"{len(work)} times a mutant before a program, {cost:.0f} s if none fails", flush=True)

    def one(mutant, cases, coming):
        failed = cases.play(mutant.number, coming, enough)
        matrix.add(mutant.number, cases.program.name, enough, failed)
        print(f"{mutant.number:4} {cases.program.name}: {len(failed)} of {len(coming)}", flush=True)

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for done in [pool.submit(one, *each) for each in work]:
            done.result()
    matrix.write()
