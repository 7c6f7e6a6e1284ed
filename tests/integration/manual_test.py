# SPDX-License-Identifier: Apache-2.0
"""The pages of the manual, tried as a reader does: what stands in ```json is written to gateway.json, what stands in ```sh is typed, line by
line, and what then stands in ```text must be what is shown. Numbers may differ, and a line `...` stands for any lines.

AXISGATE_WRITE_PAGES=1 puts what is shown into the page, where it differs.
"""
import os
import re
import subprocess

from hand_stage import OnTerminal
from processes import NEVER, Program, until
from profile_try_test import PROMPT
from stage import AXISGATE, PORTS, SIMULATOR, SOURCE, Story, main

BLOCK = re.compile(r"^```(json|sh|text)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
ANSWERS = 12 * "yes\n"  # to commission
PLAIN = re.compile(r"\d+(?:[.,:]\d+)*")


def alike(shown):
    """Without numbers, and with one space for several: columns become wider with what stands in them."""
    return [" ".join(PLAIN.sub("#", line).split()) for line in shown.rstrip().splitlines()]


def fits(printed, shown):
    """`...` is any number of lines."""
    if not printed:
        return not shown
    if printed[0] == "...":
        return any(fits(printed[1:], shown[place:]) for place in range(len(shown) + 1))
    return bool(shown) and printed[0] == shown[0] and fits(printed[1:], shown[1:])


class Reader:
    """One who goes through a page from its top, at a machine where the gateway's programs are installed."""

    def __init__(self, story, path):
        self.story, self.path = story, path
        self.folder = story.path("desk")
        os.makedirs(f"{self.folder}/bin")
        for program in (AXISGATE, SIMULATOR):
            os.symlink(program, f"{self.folder}/bin/{os.path.basename(program)}")
        self.environment = {**os.environ, "PATH": f"{self.folder}/bin:/usr/bin:{os.environ['PATH']}", "NO_COLOR": "1"}
        self.ports = {}
        self.configuration, self.last, self.typed, self.wrong = "", "", [], []

    def here(self, text):
        """The page's ports are somebody else's on this machine."""
        def port(found):
            return str(self.ports.setdefault(found[0], PORTS.free()))
        return re.sub(r"\b150[2-9]\b", port, text)

    def there(self, text):
        for name, port in self.ports.items():
            text = re.sub(rf"\b{port}\b", name, text)
        return text

    def read(self):
        with open(self.path, encoding="utf-8") as file:
            text = self.text = file.read()
        for found in BLOCK.finditer(text):
            kind, body = found.groups()
            if kind == "json":
                self.configuration = self.here(body)
            elif kind == "text":
                self.compare(body)
            else:
                self.last = ""
                for line in body.replace("\\\n", " ").splitlines():
                    if line.split("#")[0].strip():
                        self.type(line)

    def configure(self, words):
        """As the page has it; where a drive is asked, with more time for an answer, since this machine is busy with something else."""
        asks = words[1:2] in (["run"], ["commission"]) or words[1:3] == ["profile", "try"]
        with open(f"{self.folder}/gateway.json", "w", encoding="utf-8") as file:
            file.write(re.sub(r'"adapter":', '"timeout_ms": 1000, "adapter":', self.configuration) if asks else self.configuration)

    def type(self, line):
        self.typed.append(line)
        words = line.split()
        if self.configuration:
            self.configure(words)
        command = self.here(line)
        if words[:2] == ["axisgate", "run"] or words[0] == "axisgate-sim":
            self.go_on(words, command)
            return
        if words[:2] == ["axisgate", "enable"]:
            self.hold(command)
            return
        if words[:3] == ["axisgate", "profile", "try"] and "--dry" not in words:
            self.try_it(command)
            return
        if words[:2] == ["axisgate", "top"]:
            command = f"{command.split('#')[0]} --once"
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment, input=ANSWERS, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=NEVER, check=False)
        self.last += self.there(done.stdout)
        # What was asked at a factory-fresh drive may be left to a person.
        if done.returncode != 0 and words[:2] != ["axisgate", "commission"]:
            raise AssertionError(f"{line}: {done.returncode}\n{self.last}")

    def go_on(self, words, command):
        """What keeps its terminal. The gateway has seen its drives before the reader types on."""
        program = self.story.keep(Program(words[0], ["bash", "-c", f"exec {command}"], cwd=self.folder, env=self.environment))
        if words[0] == "axisgate-sim":
            program.wait_for("^ready ")
        else:
            program.wait_for(r"listening on .*")
            program.wait_for(r"axis \d+.*: online")
            self.configuration = ""  # it watches its file
        self.last = self.there(program.text())

    def hold(self, command):
        """Until Ctrl-C, which comes once it is enabled."""
        program = self.story.keep(Program("axisgate enable", ["bash", "-c", f"exec {command}"], cwd=self.folder, env=self.environment))
        program.wait_for("standstill")
        program.send(2)
        program.ended()
        self.last = self.there(program.text())

    def try_it(self, command):
        """Consents to each step, and has seen nothing wrong at the shaft."""
        program = self.story.keep(OnTerminal(["bash", "-c", f"exec {command}"], cwd=self.folder, env=self.environment))
        program.name = "axisgate profile try"
        answered = 0

        def asked():
            prompts = list(PROMPT.finditer(" ".join(program.text().split())))
            return prompts[answered] if len(prompts) > answered else program.process.poll() is not None
        while (prompt := until("it asks, or ends", asked)) is not True:
            answered += 1
            program.press((prompt[1] or ("yes" if prompt[2] else "skip")).encode() + b"\n")
        self.last = self.there(program.text().replace("\r", ""))
        if program.ended() != 0:
            raise AssertionError(f"{command}\n{self.last}")

    def compare(self, body):
        if fits(alike(body), alike(self.last)):
            return
        if os.environ.get("AXISGATE_WRITE_PAGES"):
            self.text = self.text.replace(f"```text\n{body}```", f"```text\n{self.last.rstrip()}\n```", 1)
            with open(self.path, "w", encoding="utf-8") as file:
                file.write(self.text)
        else:
            self.wrong.append(f"{self.typed[-1]} shows\n{self.last}\nand the page has\n{body}")


class OfPages(Story):
    def read(self, page, folder=None):
        """`folder`: where the page says to be, with its own configuration."""
        reader = Reader(self, f"{SOURCE}/docs/{page}")
        for name in os.listdir(folder) if folder else ():
            if name != "gateway.json":
                os.symlink(f"{folder}/{name}", f"{reader.folder}/{name}")
                continue
            with open(f"{folder}/{name}", encoding="utf-8") as file:
                reader.configuration = reader.here(file.read())
        reader.read()
        self.assertFalse(reader.wrong, "\n".join(reader.wrong))
        self.assertTrue(reader.typed, f"{page} has nothing to type")
        for program in reversed(self.programs):
            program.clean_up()


class Manual(OfPages):
    def test_quick_start(self):
        self.read("quick_start.md")

    def test_new_drive(self):
        self.read("new_drive.md", f"{SOURCE}/deploy/examples/new_drive")

    def test_panels(self):
        self.read("panels.md")

    def test_examples(self):
        self.read("../deploy/examples/README.md", f"{SOURCE}/deploy/examples/modbus")

    def test_upgrade(self):
        self.read("upgrade.md")


class Drives(OfPages):
    def test_kinco_jd(self):
        self.read("drives/kinco-jd.md")

    def test_kinco_md(self):
        self.read("drives/kinco-md.md")

    def test_leadshine_ld2_can(self):
        self.read("drives/leadshine-ld2-can.md")

    def test_id286pro(self):
        self.read("drives/id286pro.md")

    def test_keya_kydas4860_2e(self):
        self.read("drives/keya-kydas4860-2e.md")


if __name__ == "__main__":
    main()
