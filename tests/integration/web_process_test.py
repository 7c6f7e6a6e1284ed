# SPDX-License-Identifier: Apache-2.0
"""axisgate-web dies, stands still, or is not there: no drive and no Modbus client notices, and the page comes back. What it has captured
of a fault, somebody finds there."""
import csv
import http.client
import io
import json
import os
import re
import signal
import socket
import stat
import subprocess
import sys
import tarfile
import time
from contextlib import closing, suppress
from datetime import datetime, timedelta
from pathlib import Path

from processes import NEVER, Program, until
from stage import AXISGATE, PORTS, SOURCE, Story, main

sys.path.insert(0, f"{SOURCE}/tests/docs")
from page_commands import of_page  # noqa: E402

RPM = 1000  # of a register
PROMTOOL = f"{SOURCE}/.deps/prometheus/usr/bin/promtool"


def plotjuggler(text):
    """{column: [(time, value)]} as its loader of CSV files (DataLoadCSV) reads a table: the sign that the first line has most of separates,
    a line ends with its line, a row of another length is left out, and what a column holds is told by its first cell that is not empty."""
    lines = text.splitlines()
    separator = max("\t;,", key=lines[0].count)
    names = lines[0].split(separator)
    columns, number = {name: [] for name in names}, re.compile(r"[+-]?[0-9.,]+$")
    for line in lines[1:]:
        cells = [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
        if len(cells) != len(names):
            raise AssertionError(f"another length than the names have: {line}")
        at = datetime.strptime(cells[0], "%Y-%m-%dT%H:%M:%S.%fZ").timestamp()
        for name, cell in zip(names[1:-1], cells[1:-1]):
            if cell and not number.match(cell):
                raise AssertionError(f"it would be taken for a text: {line}")
            if cell:
                columns[name].append((at, float(cell.replace(",", "."))))
    return columns


class Page(Story):
    """A motor turns while something happens to the page."""

    more = {}  # of the section web

    def configure(self, listeners=None, buses=None, name="gateway.json"):
        config = super().configure(listeners, buses, name)
        self.page_port = PORTS.free()
        self.change(web={"listen": f"127.0.0.1:{self.page_port}", **self.more})
        return config

    def change(self, **sections):
        with open(self.config, encoding="utf-8") as file:
            config = json.load(file)
        for key, section in sections.items():
            config.pop(key, None)
            if section is not None:
                config[key] = section
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(config, file, indent=2)

    def process(self):
        """Of axisgate-web, a child of the gateway; None: there is none."""
        for pid in filter(str.isdigit, os.listdir("/proc")):
            with suppress(OSError, IndexError):
                with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
                    name, rest = file.read().rsplit(")", 1)
                if name.endswith("(axisgate-web") and rest.split()[1] == str(self.gateway.pid) and rest.split()[0] != "Z":
                    return int(pid)
        return None

    def get(self, path, port=None):
        return json.loads(self.get_text(path, port))

    def get_text(self, path, port=None):
        with closing(http.client.HTTPConnection("127.0.0.1", port or self.page_port, timeout=NEVER)) as connection:
            connection.request("GET", path)
            return connection.getresponse().read().decode()

    def answers(self, port=None):
        with suppress(OSError, http.client.HTTPException):
            return self.get("/api/v1/gateway", port).get("joined")
        return False

    def run_motor(self):
        self.start()
        until("the page", self.answers)
        axis = self.axis(1)
        axis.command("enable")
        axis.set(target_velocity=200 * RPM)
        axis.command("run_velocity")
        until("it turns", lambda: axis.get("velocity_actual") > 150 * RPM)

    def turns(self):
        return self.axis(1).get("velocity_actual") > 150 * RPM


class Disturbed(Page):
    def signal(self, number):
        pid = self.process()

        def go_on():
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)

        self.addCleanup(go_on)
        os.kill(pid, number)
        return pid

    def test_killed_it_is_back_and_nothing_else_has_changed(self):
        self.run_motor()
        before = self.signal(signal.SIGKILL)
        self.gateway.wait_for("axisgate-web was killed: signal 9")
        until("another one answers", lambda: self.process() not in (None, before) and self.answers())
        self.assertTrue(self.turns())
        programs = self.get("/api/v1/gateway")["programs"]
        self.assertEqual([each["restarts"] for each in programs if each["name"] == "axisgate-web"], [1])

    def test_standing_still_it_is_replaced(self):
        self.run_motor()
        before = self.signal(signal.SIGSTOP)
        self.gateway.wait_for("axisgate-web took nothing from the gateway for too long and was killed")
        until("another one answers", lambda: self.process() not in (None, before) and self.answers())
        self.assertTrue(self.turns())


class Captured(Page):
    """A motor that turns faults. Nobody has armed anything."""

    before_s = 2

    def configure(self, listeners=None, buses=None, name="gateway.json"):
        self.captures = Path(self.path("captures"))
        self.more = {"captures": {"before_s": self.before_s, "after_s": 2, "folder": str(self.captures)}}
        return super().configure(listeners, buses, name)

    def turned_for_long(self):
        """It is known to have turned for more than what a capture holds before its cause."""
        lines = self.get(f"/api/v1/history?series=1.velocity_rpm&from=-{self.before_s + 0.5}&points=16")
        slices = lines["series"]["1.velocity_rpm"]
        return slices and slices[0][0] == lines["from"] and all(low is not None and low > 150 for _, low, _ in slices)

    def complete(self):
        return [capture for capture in self.get("/api/v1/captures")["captures"] if capture["complete"]]

    def typed(self, command, name="ID"):
        """As it stands on the page, at this port."""
        command = command.replace("127.0.0.1:8080", f"127.0.0.1:{self.page_port}").replace("ID", name)
        done = subprocess.run(["sh", "-c", command], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stdout}{done.stderr}")
        return done.stdout

    def test_a_fault_in_motion_is_captured_with_the_motion_before_it_and_outlives_the_process(self):
        self.run_motor()
        until("it has turned for long", self.turned_for_long)
        self.sim.ask("fault lift/1 2601 0x0020")
        capture = until("a capture", self.complete)[0]
        self.assertEqual((capture["cause"], capture["axis"]), ("fault", 1))
        self.assertEqual(self.get("/api/v1/axes/1")["capture"], capture["id"])
        whole = self.get(f"/api/v1/captures/{capture['id']}")
        self.assertGreaterEqual(datetime.fromisoformat(capture["at"]) - datetime.fromisoformat(capture["from"]), timedelta(seconds=self.before_s))
        self.assertGreater(whole["series"]["1.velocity_rpm"][0][1], 100, "the motion before the fault")
        [named] = [event["text"] for event in whole["events"] if event["kind"] == "fault"]
        self.assertEqual(capture["text"], named)
        listed = json.loads(self.typed(of_page("docs/web.md", "curl -s 'http://127.0.0.1:8080/api/v1/captures")))
        self.assertEqual(listed["captures"], [capture])
        self.typed(of_page("docs/web.md", "curl -s http://127.0.0.1:8080/api/v1/captures/ID.csv"), capture["id"])
        table = (Path(self.folder) / "capture.csv").read_bytes().decode()
        rows = list(csv.DictReader(io.StringIO(table)))
        self.assertEqual((rows[0]["time"], rows[-1]["time"]), (capture["from"], capture["to"]))
        self.assertGreater(float(rows[0]["1.velocity_rpm"]), 100)
        self.assertTrue(any(named in row["event"] for row in rows))
        [file] = self.captures.iterdir()
        self.assertEqual((file.name, stat.S_IMODE(file.stat().st_mode)), (f"{capture['id']}.capture", 0o640))

        pid = self.process()
        os.kill(pid, signal.SIGKILL)
        until("another one answers", lambda: self.process() not in (None, pid) and self.answers())
        self.assertEqual(self.complete(), [capture])
        self.assertEqual(self.get_text(f"/api/v1/captures/{capture['id']}.csv"), table)


class Recorded(Page):
    """axisgate record, from a shell."""

    series = "velocity_rpm,axis_state"

    def record(self, *arguments):
        return self.command_line("record", *arguments, "--series", self.series, "--config", self.config)

    def rows(self, text):
        head, *rows = csv.reader(io.StringIO(text, newline=""))
        self.assertEqual(head, ["time", "1.velocity_rpm", "1.axis_state", "event"])
        self.assertEqual(rows, sorted(rows, key=lambda row: row[0]))
        return rows

    def refused(self, why, *arguments):
        done = self.record(*arguments)
        self.assertEqual(done.returncode, 1)
        self.assertIn(why, done.stderr)

    def helped(self, name):
        done = self.command_line(of_page("docs/troubleshooting.md", "axisgate support").split()[1], self.config, "--yes", "--output", self.path(name))
        self.assertEqual(done.returncode, 0, done.stderr)
        with tarfile.open(self.path(name)) as archive:
            return done.stdout, {os.path.basename(member.name): archive.extractfile(member).read().decode() for member in archive}

    def test_what_an_axis_did_and_does_comes_as_a_csv(self):
        self.run_motor()
        self.refused("there is no axis 9", "9")
        before = self.record("1", "--before", "60")
        self.assertEqual(before.returncode, 0, before.stderr)
        self.assertIn("the page's history does not hold", before.stderr)
        rows = self.rows(before.stdout)
        self.assertGreater(float(rows[-1][1]), 150)
        self.assertIn("run_velocity", "".join(row[3] for row in rows))

        said, files = self.helped("moving.tar.gz")
        self.assertTrue(self.turns(), "nobody has noticed")
        self.assertTrue(said.startswith(files["README.txt"]))
        self.assertGreater(json.loads(files["axes.json"])["axes"][0]["values"]["velocity_rpm"], 150)
        for file, holds in (("events.json", "run_velocity"), ("metrics.txt", "axisgate_"), ("top.txt", "online"), ("check.txt", "http://127.0.0.1:"),
                            ("devices.txt", f"open in axisgate (pid {self.gateway.pid}, "), ("profiles.txt", "kinco-jd.json"), ("configuration.json", "web")):
            self.assertIn(holds, files[file], file)
        recording = self.keep(Program("record", [AXISGATE, "record", "1", "--seconds", "3600", "--csv", "--series", self.series, "--output",
                                                 self.path("stop.csv"), "--url", f"http://127.0.0.1:{self.page_port}/"]))
        recording.wait_for("Ctrl-C ends it")
        self.axis(1).command("quick_stop")
        until("the page shows that it stands", lambda: self.get("/api/v1/axes/1")["values"]["velocity_rpm"] == 0)
        recording.send(signal.SIGINT)
        self.assertEqual(recording.ended(), 0, recording.text())
        with open(self.path("stop.csv"), encoding="utf-8", newline="") as file:
            rows = self.rows(file.read())
        self.assertGreater(float(rows[0][1]), 150)
        self.assertEqual(float(rows[-1][1]), 0)
        self.assertIn("quick_stop", "".join(row[3] for row in rows))

        self.gateway.terminate()
        self.refused("Does the gateway run", "1")
        self.assertRegex(self.helped("ended.tar.gz")[0], r"top.txt +axisgate top: .*: Connection refused\n(.*\n)*  page/axes.json .*: Connection refused")
        self.change(web=None)
        self.refused('no page is configured, and its history is what is recorded: add "web": {}', "1")


class Ends(Page):
    def test_it_ends_with_the_gateway_and_frees_its_port(self):
        self.run_motor()
        pid = self.process()
        self.gateway.send(signal.SIGKILL)
        self.gateway.ended()
        until("its end", lambda: not os.path.exists(f"/proc/{pid}"))
        with socket.socket() as next_one:
            next_one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            next_one.bind(("127.0.0.1", self.page_port))

    def test_an_address_in_use_ends_the_page_alone(self):
        self.simulate()
        self.configure()
        with socket.socket() as holder:
            holder.bind(("127.0.0.1", self.page_port))
            holder.listen()
            self.run_gateway()
            self.gateway.wait_for("axisgate-web cannot listen on the address of `web`")
            self.client = self.connect()
            self.until_online()
        until("the page", self.answers)


class Reloaded(Page):
    def history_is_what_the_registers_were(self):
        """Of a position that rises: no sample of before a look is above what it saw, none of behind it below."""
        clock_differs = 0.01
        looks, axis = [], self.axis(1)
        while len(looks) < 10:
            before = time.time()
            seen = axis.get("position_actual") / 10000
            if not looks or seen > looks[-1][1]:
                looks.append((before - clock_differs, seen, time.time() + clock_differs))
        newest = looks[-1][2]
        series = "1.position_rev"

        def rows():
            return list(csv.DictReader(io.StringIO(self.get_text(f"/api/v1/history.csv?series={series}"), newline="")))

        def when(row):
            return datetime.fromisoformat(row["time"].replace("Z", "+00:00")).timestamp()

        until("a sample behind the last look", lambda: sum(1 for row in rows() if when(row) > newest) > 2)
        samples = [(when(row), float(row[series])) for row in rows()[:-1] if not row["event"] and row[series]]
        self.assertGreaterEqual(len(samples), len(looks))
        for before, seen, after in looks:
            self.assertEqual([each for each in samples if each[0] <= before and each[1] > seen], [])
            self.assertEqual([each for each in samples if each[0] >= after and each[1] < seen], [])

    def history_as_its_page_asks(self):
        def typed(command):
            done = subprocess.run(command.replace("127.0.0.1:8080", f"127.0.0.1:{self.page_port}"), shell=True, cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, f"{command}: {done.stdout}{done.stderr}")
            return done.stdout

        series = json.loads(typed(of_page("docs/web.md", "curl -s 'http://127.0.0.1:8080/api/v1/history?")))["series"]
        self.assertGreater(max(slice[2] or 0 for slice in series["1.velocity_rpm"]), 150)
        typed(of_page("docs/web.md", "curl -s 'http://127.0.0.1:8080/api/v1/history.csv?"))
        with open(os.path.join(self.folder, "axis1_velocity.csv"), encoding="utf-8", newline="") as file:
            velocity = plotjuggler(file.read())["1.velocity_rpm"]
        self.assertGreater(max(value for _, value in velocity), 150)
        self.assertEqual([at for at, _ in velocity], sorted(at for at, _ in velocity))

    def reload(self):
        done = self.command_line("reload", self.config)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_another_address_is_served_beside_a_motor_that_turns(self):
        self.run_motor()
        self.history_is_what_the_registers_were()
        self.history_as_its_page_asks()
        other = PORTS.free()
        self.change(web={"listen": f"127.0.0.1:{other}"})
        self.assertIn("web: changed", self.reload())
        until("the page at its new address", lambda: self.answers(other))
        self.assertFalse(self.answers())
        self.assertTrue(self.turns())
        self.change(web=None)
        self.assertIn("web: removed", self.reload())
        until("no page", lambda: self.process() is None)
        self.assertTrue(self.turns())
        self.change(web={"listen": f"127.0.0.1:{other}"})
        self.reload()
        until("the page again", lambda: self.answers(other))


class Scraped(Page):
    """By Prometheus, at the path that docs/monitoring.md shows."""

    def ask(self, method="GET"):
        path = of_page("docs/monitoring.md", "curl -s http").split()[-1].partition(":8080")[2]
        with closing(http.client.HTTPConnection("127.0.0.1", self.page_port, timeout=NEVER)) as connection:
            connection.request(method, path)
            answer = connection.getresponse()
            return answer, answer.read().decode()

    def scrape(self):
        """By name and labels; None: there is no answer, not all of it, or we ask too often."""
        with suppress(OSError, http.client.HTTPException):
            answer, text = self.ask()
            if answer.status == http.HTTPStatus.TOO_MANY_REQUESTS:
                return None
            self.assertEqual(answer.status, 200)
            return {name: float(value) for name, _, value in (line.rpartition(" ") for line in text.splitlines() if not line.startswith("#"))}
        return None

    def value(self, name, **labels):
        labels = ",".join(f'{key}="{value}"' for key, value in labels.items())
        return (self.scrape() or {}).get(f"axisgate_{name}{{{labels}}}" if labels else f"axisgate_{name}")

    def test_it_finds_nothing_wrong_and_counters_that_rise_until_the_gateway_is_another(self):
        self.run_motor()
        until("what was commanded", lambda: self.value("axis_commands_total", axis="1", command="run_velocity", result="done") == 1)
        until("a second of motion", lambda: self.value("axis_enabled_seconds_total", axis="1") > 1)
        self.assertEqual(self.value("axis_state", axis="1", state="continuous_motion"), 1)
        answer, text = self.ask()
        self.assertEqual(answer.getheader("Content-Type"), "text/plain; version=0.0.4; charset=utf-8")
        linted = subprocess.run([PROMTOOL, "check", "metrics"], input=text, capture_output=True, text=True, check=False)
        self.assertEqual((linted.returncode, linted.stdout + linted.stderr), (0, ""))
        head, nothing = self.ask("HEAD")
        self.assertEqual((head.status, nothing), (200, ""))

        first = until("a scrape", self.scrape)
        self.assertTrue(self.turns())
        way = 'axisgate_axis_travel_revolutions_total{axis="1"}'
        second = until("its way", lambda: (told := self.scrape()) and told[way] > first[way] + 1 and told)
        counters = [line for line in first if line.partition("{")[0].endswith(("_total", "_bucket", "_count", "_sum"))]
        self.assertGreater(len(counters), 200)
        self.assertEqual([line for line in counters if second[line] < first[line]], [])
        for line in ("axisgate_modbus_requests_total", "axisgate_loop_delay_seconds_count", 'axisgate_bus_busy_seconds_total{bus="lift"}',
                     'axisgate_bus_wait_seconds_count{bus="lift",class="poll"}', "axisgate_web_requests_total"):
            self.assertGreater(second[line], first[line], line)
        self.assertEqual(second['axisgate_axis_travel_revolutions_total{axis="2"}'], 0, "it stands")

        self.gateway.send(signal.SIGTERM)
        while self.gateway.process.poll() is None:
            told = self.scrape()
            self.assertTrue(told is None or "axisgate_up" in told)
        self.run_gateway()
        until("another gateway's", lambda: self.value("axis_commands_total", axis="1", command="run_velocity", result="done") == 0)


if __name__ == "__main__":
    main()
