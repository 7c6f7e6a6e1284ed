# SPDX-License-Identifier: Apache-2.0
"""A cell with a page: six axes of every maker on simulated lines, the real gateway with its web server, one browser before them.

A story is run as: STORY_test.py AXISGATE AXISGATE_SIM SOURCE_FOLDER [unittest's arguments]
"""
import gzip
import json
import os
import signal
import socket
import sys
import tempfile
import urllib.error
import urllib.request
from contextlib import suppress

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "integration"))

from browser import Browser
from disturbance import UndisturbedTest, family, read
from modbus import CONTINUOUS, DISABLED, ONLINE, Client
from processes import until
from stage import DRIVES, PORTS, Gateway, Simulator, bus, drive, main

DRIVES["ld2"] = ("leadshine-ld2-can", {})
LINES = {"lift": "jd@1", "feeder": "md@1", "turntable": "rtu:id286pro@1", "press": "lawicel:ld2@1", "wheels": "lawicel:keya-can@1"}
NAMES = {1: "lift", 2: "<b>feeder</b>", 3: "turntable", 4: "press", 5: "left wheel", 6: "right wheel"}
PAGES = ("axes", "axis/1", "axis/3", "axis/5", "scope/s=1.velocity_rpm,5.velocity_rpm,3.position_rev,1.axis_state", "captures", "buses", "events", "map", "words", "about")
RPM = 1000


def keya(first):
    axes = [{"axis": number, "name": NAMES[number], "motor": motor, "lease": None} for number, motor in ((first, "A"), (first + 1, "B"))]
    return {"profile": "keya-kydas4860-2e", "node": 1, "constants": {"rated_speed_a_rpm": 1500, "rated_speed_b_rpm": 1500}, "axes": axes}


class Cell:
    """Programs of one cell, started once for all stories of a class."""

    def __init__(self, names=None, host="127.0.0.1", relative=False, sim_options=(), **web):
        """`relative`: devices are called by their names alone, as for a picture; this process works in their folder then."""
        self.folder = tempfile.TemporaryDirectory(prefix="axisgate-web-")
        self.names = {**NAMES, **(names or {})}
        if relative:
            os.chdir(self.folder.name)

        def path(name):
            return name if relative else f"{self.folder.name}/{name}"

        def named(kind, number, **more):
            return drive(kind, 1, number, name=self.names[number], **more)

        self.web_port, self.port = PORTS.free(), PORTS.free()
        self.config = path("gateway.json")
        buses = [bus(path("lift"), named("jd", 1, lease={"timeout_ms": 60000})), bus(path("feeder"), named("md", 2)),
                 bus(path("turntable"), named("id286pro", 3), adapter="modbus-rtu"),
                 bus("slcan:" + path("press"), named("ld2", 4), adapter="canopen", bitrate=500000, name="press"),
                 bus("slcan:" + path("wheels"), keya(5), adapter="keya-can", bitrate=250000, name="wheels")]
        for each in buses:
            if each["device"].startswith("slcan:"):
                del each["rs485"]
        config = {"gateway": {"name": "cell_7"}, "modbus_tcp": [{"listen": f"127.0.0.1:{self.port}", "client": "address"}],
                  "web": {"listen": f"{host}:{self.web_port}", **web}, "buses": buses}
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(config, file, indent=2)
        self.sim = Simulator(self.folder.name, LINES, *sim_options)
        self.gateway, self.clients = None, []

    def start(self):
        """Returns when every axis is online and the page is served."""
        self.gateway = Gateway(self.config)
        self.gateway.wait_until_it_listens()
        self.client = self.connect()
        until("all axes online", lambda: (g := self.client.gateway())["axes_online"] == g["axis_count"])
        until("the page is served", self.is_served)
        return self

    def is_served(self):
        try:
            return self.get("api/v1/health")["joined"]
        except OSError:
            return False

    def connect(self):
        client = Client(self.port)
        self.clients.append(client)
        return client

    def axis(self, number):
        return self.client.axis(number)

    @property
    def address(self):
        return f"http://127.0.0.1:{self.web_port}/"

    def fetch(self, path, **fields):
        """(status, body, bytes on the wire)"""
        request = urllib.request.Request(self.address + path, headers=fields)
        try:
            answer = urllib.request.urlopen(request, timeout=60)
        except urllib.error.HTTPError as refused:
            answer = refused
        with answer:
            body = answer.read()
            plain = gzip.decompress(body) if answer.headers.get("Content-Encoding") == "gzip" else body
            return answer.status, plain, len(body)

    def get(self, path):
        return json.loads(self.fetch(path)[1])

    def open_stream(self):
        """Somebody else's, held until it is closed."""
        connection = socket.create_connection(("127.0.0.1", self.web_port), timeout=60)
        connection.sendall(f"GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1:{self.web_port}\r\n\r\n".encode())
        until("the stream is answered", lambda: b"200" in connection.recv(64))
        return connection

    def fresh(self):
        """Asked by a new connection from here on: the gateway closes one that was idle for long."""
        self.client = self.connect()
        return self

    def calm(self):
        """Without faults: a drive may have noticed that the gateway had died."""
        for number in NAMES:
            axis = self.axis(number)
            until(f"axis {number} is known", lambda: axis.get("link_state") == ONLINE and axis.get("error_code") != 0xFFFF)
            if axis.get("error_code") != 0:
                axis.command("fault_reset")
                axis.until(error_code=0)

    def run(self, number, rpm):
        axis = self.axis(number)
        axis.set(target_velocity=rpm * RPM)
        axis.command("enable")
        axis.command("run_velocity")
        axis.until(axis_state=CONTINUOUS)

    def rest(self, number):
        """Without a latch, disabled."""
        axis = self.fresh().axis(number)
        axis.command("quick_stop")
        axis.command("enable")
        axis.command("disable")
        axis.until(axis_state=DISABLED)

    def web_pid(self):
        """Of axisgate-web, the gateway's child."""
        return next(process for process in family(self.gateway.pid) if read(f"/proc/{process}/comm").startswith("axisgate-web"))

    def go_on(self, process):
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGCONT)

    def kill_gateway(self):
        self.gateway.clean_up()
        for client in self.clients:
            client.close()
        self.clients.clear()

    def clean_up(self):
        for client in self.clients:
            client.close()
        if self.gateway:
            self.gateway.clean_up()
        self.sim.clean_up()
        self.folder.cleanup()

    def log(self):
        return f"--- gateway\n{self.gateway.text() if self.gateway else ''}\n--- simulator\n{self.sim.text()}"


class PageStory(UndisturbedTest):
    """Cell and browser are the class's; every story leaves the cell as it found it."""

    web = {}

    @classmethod
    def setUpClass(cls):
        cls.cell = Cell(**cls.web)
        cls.addClassCleanup(lambda: cls.cell.clean_up())
        cls.cell.start()
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def run_once(self, result):
        super().run_once(result)
        if not result.wasSuccessful():
            print(self.cell.log(), file=sys.stderr)

    def setUp(self):
        self.cell.fresh().calm()
        self.browser.size("desk")
        self.browser.go("about:blank")
        self.browser.complaints()

    def open(self, page=""):
        """A page that lives: its first values are there."""
        self.browser.go(self.cell.address + (f"#{page}" if page else ""))
        self.browser.until("the page lives", self.lives)

    def lives(self):
        """It hears, has a heading, and nothing covers it."""
        return "live" in self.browser.text("#stream-state") and self.browser.texts("main h1") and not self.browser.texts("#not-seen")

    def move_to(self, page):
        """As a link does it: the page stays the same."""
        self.browser.run("location.hash = arguments[0]", page)
        self.browser.until(f"page {page}", lambda: self.browser.run("return document.body.dataset.page") == page.split("/")[0] and self.lives())

    def assert_axe_finds_nothing(self):
        """On the page as it stands, into which axe-core was put."""
        found = self.browser.run_later("const found = await axe.run(document, {resultTypes: ['violations']}); done(JSON.stringify(found.violations.map(v => [v.id, v.help, v.nodes.map(n => n.html.slice(0, 200))])))")
        self.assertEqual(json.loads(found), [])

    def figures(self, axis, what):
        """What the line of an axis shows of a value: (text, quality)."""
        found = self.browser.run("const e = document.querySelector(arguments[0]); return e && [e.querySelector('.figure').textContent, e.dataset.quality]", f"#axis-{axis} .of-{what} .value")
        return tuple(found or ("", ""))

    def number(self, axis, what):
        text, _ = self.figures(axis, what)
        try:
            return float(text.replace("−", "-").replace("\u202f", ""))
        except ValueError:
            return None


__all__ = ["Cell", "PageStory", "PAGES", "NAMES", "ONLINE", "RPM", "main"]
