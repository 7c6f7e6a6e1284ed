# SPDX-License-Identifier: Apache-2.0
"""What a person sees of a cell on its page: values that live, faults with their remedy, cables that are out, a gateway that dies.

AXISGATE_PICTURES=FOLDER keeps a picture of each page there, at each width, in both themes."""
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

from web_stage import NAMES, ONLINE, PAGES, PageStory, main  # first: it knows where the others' modules are

from axe import axe_core
from browser import Keys, SIZES, THEMES
from stage import SOURCE

sys.path.insert(0, f"{SOURCE}/tests/docs")
from page_commands import of_page

PICTURES = os.environ.get("AXISGATE_PICTURES")
LOOKED_AT = {"phone": "light", "desk": "dark"}  # by axe: colours are one matter, places another
WEIGHT = 120 * 1024


class Values(PageStory):
    def test_every_page_opens_without_a_complaint_and_asks_nobody_else(self):
        for page in PAGES:
            with self.subTest(page):
                self.open(page)
                self.browser.until("there is something to see", lambda: len(self.browser.text("main")) > 60)
                asked = self.browser.run("return performance.getEntriesByType('resource').map(e => e.name)")
                self.assertEqual([name for name in asked if not name.startswith(self.cell.address)], [])
                self.assertEqual(self.browser.complaints(), [])
                self.assertEqual(self.browser.run("return document.documentElement.lang"), "en")
                self.browser.go("about:blank")

    def test_values_change_while_an_axis_moves_and_its_line_stays_the_same(self):
        self.open()
        self.browser.run("window.line = document.querySelector('#axis-1')")
        self.addCleanup(self.cell.rest, 1)
        self.cell.run(1, 60)
        self.browser.until("its speed is shown", lambda: abs((self.number(1, "velocity_rpm") or 0) - 60) < 6)
        self.browser.until_text("#axis-1 .of-state", "continuous motion")
        before = self.number(1, "position_rev")
        self.browser.until("its position goes on", lambda: self.number(1, "position_rev") > before + 1)
        self.assertTrue(self.browser.run("return window.line === document.querySelector('#axis-1')"))
        self.assertEqual(self.figures(1, "position_rev")[1], "good")
        self.browser.until_text("#axis-1 .of-owner", "127.0.0.1")
        self.browser.until_text(".sums", "1 moving")

    def test_one_axis_shows_all_of_itself(self):
        self.addCleanup(self.cell.rest, 5)
        self.cell.run(5, 30)
        self.open("axis/5")
        self.browser.until("the large figure runs", lambda: any(text.startswith(("29", "30", "31")) for text in self.browser.texts("[data-name=velocity_rpm] .figure")))
        self.browser.until_text(".commands", "run velocity")
        self.browser.until_text(".commands", "127.0.0.1")
        self.assertIn("1000 ms", self.browser.text("main"), "how soon it stops by itself")
        self.browser.press("details summary")
        self.browser.until("the plot as a table", lambda: len(self.browser.texts("details tbody tr")) > 1)

    def test_what_stands_against_a_motion_is_said_with_its_remedy(self):
        self.open("axis/2")
        self.browser.until_text("#blocked", "disabled")
        self.browser.until_text("#blocked", "enable: command 1")
        self.addCleanup(self.cell.rest, 2)
        axis = self.cell.axis(2)
        axis.command("enable")
        axis.command("quick_stop")
        self.browser.until_text("#blocked", "stop latched")
        self.browser.until_text("#axis-head .states", "latched")

    def test_names_are_texts_whatever_stands_in_them(self):
        self.open()
        self.assertEqual(self.browser.text("#axis-2 .name"), NAMES[2])
        self.assertEqual(self.browser.texts("main b b, main .name b"), [])
        self.move_to("axis/2")
        self.browser.until_text("h1", NAMES[2])

    def test_buses_show_the_plan_beside_what_is(self):
        self.open("buses")
        self.browser.until("all buses", lambda: len(self.browser.texts(".bus")) == 5)
        first = self.browser.texts(".bus:first-child .counters dd")[0]
        self.browser.until("it counts on", lambda: self.browser.texts(".bus:first-child .counters dd")[0] != first)
        self.browser.until_text(".bus:first-child .times", "poll")
        self.assertEqual(len([text for text in self.browser.texts(".bus .plan tbody tr:first-child td:last-child") if float(text) > 0]), 5)

    def test_map_and_words_are_found(self):
        self.open("map")
        self.browser.until_text(".map", "position_actual")
        self.browser.type("main input", "loss_stop")
        self.browser.until("one row is left", lambda: len(self.browser.texts(".map tbody th")) == 1)
        self.assertIn("198", self.browser.text(".map tbody"))
        self.assertIn("loss_stop_ms", self.browser.text(".map tbody"))
        self.move_to("words")
        self.browser.type("main input", "stop_latched")
        self.browser.until_text(".words tbody tr:first-child", "after a stop the axis waits")
        self.browser.type("main input", "0x3211")  # known by its class alone, to the gateway
        self.browser.until_text(".words tbody", "bus voltage")


class Trouble(PageStory):
    def test_a_fault_stands_there_with_cause_and_remedy_and_is_said_once(self):
        self.open("axis/1")
        self.addCleanup(self.heal)
        self.cell.sim.ask("fault lift/1 2601 0x0020")
        self.browser.until_text("#fault", "bus voltage too high")
        self.browser.until_text("#fault", "brake resistor")
        self.browser.until_text("#announcer", "Fault of axis 1 lift")
        self.browser.until_text("#blocked", "error stop")
        self.move_to("axes")
        self.browser.until_text("#axis-1", "error stop")
        self.browser.until_text(".troubles", "brake resistor")
        self.browser.until("the title tells it", lambda: "1 faulted" in self.browser.driver.title)
        self.move_to("events")
        self.browser.until_text(".events [data-tone=act]", "1 lift")
        self.heal()
        self.move_to("axis/1")
        self.browser.until("the fault is gone", lambda: not self.browser.texts("#fault"))
        self.assertEqual(self.browser.complaints(), [])

    def test_new_events_wait_while_somebody_reads(self):
        self.open("events")
        self.browser.until("there are some", lambda: self.browser.texts(".events tbody a"))
        self.browser.run("document.querySelector('.events tbody a').focus()")
        first = self.browser.texts(".events tbody tr")[0]
        self.addCleanup(self.plug)
        self.cell.sim.ask("unplug turntable")
        self.browser.until_text(".waiting", "newer")
        self.assertEqual(self.browser.texts(".events tbody tr")[0], first)
        self.browser.press(".waiting button")
        self.browser.until("they are there", lambda: self.browser.texts(".events tbody tr")[0] != first)

    def heal(self):
        self.cell.sim.ask("clear lift/1 2601 0x0020")
        self.cell.fresh().calm()

    def test_a_pulled_cable_greys_values_and_says_how_old_they_are(self):
        self.open()
        self.browser.until("a good value", lambda: self.figures(3, "position_rev")[1] == "good")
        self.addCleanup(self.plug)
        self.cell.sim.ask("unplug turntable")
        self.browser.until("it is old", lambda: self.figures(3, "position_rev")[1] == "old")
        self.browser.until_text("#axis-3 .of-link", "link down")
        self.assertEqual(self.figures(1, "position_rev")[1], "good")
        style = "return getComputedStyle(document.querySelector(`#axis-${arguments[0]} .of-position_rev .figure`))[arguments[1]]"
        for how in ("color", "fontStyle"):  # not by its colour alone
            self.assertNotEqual(self.browser.run(style, 3, how), self.browser.run(style, 1, how))
        self.browser.until_text(".sums", "1 out of reach")
        self.move_to("axis/3")
        self.browser.until_text("[data-name=position_rev] .below", "not valid")
        self.plug()
        self.browser.until("it is new again", lambda: self.browser.attributes("[data-name=position_rev]", "data-quality") == ["good"])

    def plug(self):
        if "turntable:rtu:id286pro@1(unplugged)" in self.cell.sim.ask("lines"):
            self.cell.sim.ask("plug turntable")
        self.cell.fresh().axis(3).until(link_state=ONLINE)

    def test_a_killed_gateway_is_seen_and_the_page_goes_on_when_it_is_back(self):
        self.open()
        self.browser.run("window.here = 'the same page'")
        self.cell.kill_gateway()
        self.browser.until_text("#not-seen", "Gateway not seen since")
        self.browser.until("nothing is shown as if it were new", lambda: not self.browser.run("return document.querySelectorAll('.axes .value[data-quality=good]').length"))
        self.assertIn("Not seen", self.browser.driver.title)
        self.browser.until_text("#announcer", "Gateway not seen")
        for page in ("axis/1", "buses", "about"):
            self.browser.run("location.hash = arguments[0]", page)
            self.browser.until(f"{page} is covered too", lambda: self.browser.texts("#not-seen") and self.browser.texts("main h1"))
        self.browser.run("location.hash = 'axes'")
        self.cell.start()
        self.browser.until("it lives again", self.lives)
        self.browser.until("values are new", lambda: self.figures(1, "position_rev")[1] == "good")
        self.assertEqual(self.browser.run("return window.here"), "the same page")

    def test_what_stands_still_is_seen_as_if_it_were_gone(self):
        """Nothing is closed, and nothing comes: of the page's own server, and of the gateway behind it."""
        for who in ("axisgate-web", "gateway"):
            with self.subTest(who):
                self.open()
                stopped = self.cell.web_pid() if who == "axisgate-web" else self.cell.gateway.pid
                self.addCleanup(self.cell.go_on, stopped)
                os.kill(stopped, signal.SIGSTOP)
                self.browser.until_text("#not-seen", "Gateway not seen since")
                self.browser.until("nothing is shown as if it were new", lambda: not self.browser.run("return document.querySelectorAll('.axes .value[data-quality=good]').length"))
                self.cell.go_on(stopped)
                self.browser.until("it lives again", self.lives)

    def test_lines_stay_in_their_order_until_somebody_sorts(self):
        self.open()
        order = lambda: [text.split()[0] for text in self.browser.texts(".axes tbody .key")]
        self.assertEqual(order(), ["1", "2", "3", "4", "5", "6"])
        self.addCleanup(self.plug)
        self.cell.sim.ask("unplug turntable")
        self.browser.until_text("#axis-3 .of-link", "link down")
        self.assertEqual(order(), ["1", "2", "3", "4", "5", "6"])
        self.browser.press("#worst-first")
        self.browser.until("the worst is first", lambda: order()[0] == "3")
        self.plug()
        self.browser.until_text("#axis-3 .of-link", "online")
        self.assertEqual(order()[0], "3")


class Programs(PageStory):
    """What docs/web.md tells a program to ask, typed as it stands there."""

    def typed(self, command):
        done = subprocess.run(command.replace("127.0.0.1:8080", f"127.0.0.1:{self.cell.web_port}"), shell=True, cwd=self.cell.folder.name, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stdout}{done.stderr}")
        return done.stdout

    def test_what_is_asked_once(self):
        axis = json.loads(self.typed(of_page("docs/web.md", "curl -s http://127.0.0.1:8080/api/v1/axes/1")))
        self.assertEqual((axis["name"], axis["link_state"]), ("lift", "online"))
        self.assertIn("events", json.loads(self.typed(of_page("docs/web.md", "curl -s 'http://127.0.0.1:8080/api/v1/events"))))
        word = json.loads(self.typed(of_page("docs/web.md", "curl -s 'http://127.0.0.1:8080/api/v1/explain")))["found"][0]
        self.assertIn("waits until somebody clears it", word["meaning"])
        self.typed(of_page("docs/web.md", "curl -s 'http://127.0.0.1:8080/api/v1/map"))
        rows = Path(self.cell.folder.name, "axis1.csv").read_text(encoding="utf-8").splitlines()
        self.assertIn("position_actual", "".join(rows))
        self.assertTrue(json.loads(self.typed(of_page("docs/web.md", "curl -sf http://127.0.0.1:8080/api/v1/health")))["joined"])

    def test_the_stream(self):
        command = of_page("docs/web.md", "curl -sN").replace("127.0.0.1:8080", f"127.0.0.1:{self.cell.web_port}")
        with subprocess.Popen(["sh", "-c", f"exec {command}"], stdout=subprocess.PIPE, text=True) as curl:
            self.addCleanup(curl.wait)
            self.addCleanup(curl.kill)
            lines = (line.rstrip("\n") for line in curl.stdout)
            kinds = []
            for line in lines:
                if line.startswith("event: "):
                    kinds.append(line.removeprefix("event: "))
                if kinds.count("axes") == 2 and line.startswith("data: "):
                    break
            curl.kill()
        self.assertEqual(kinds[:2], ["hello", "axes"])
        self.assertEqual([axis["axis"] for axis in json.loads(line.removeprefix("data: "))["axes"]], [1])


class Reach(PageStory):
    """For everybody: by keyboard, by screen reader, on every width, in both themes."""

    def test_every_page_fits_every_width_and_axe_finds_nothing(self):
        self.cell.sim.ask("unplug turntable")
        self.addCleanup(lambda: self.cell.fresh().axis(3).until(link_state=ONLINE))
        self.addCleanup(self.cell.sim.ask, "plug turntable")
        self.open()
        script = axe_core()
        if script:
            self.browser.run(script)
        for page in PAGES:
            self.move_to(page)
            self.browser.until("there is something to see", lambda: len(self.browser.text("main")) > 60)
            for size, (width, _) in SIZES.items():
                self.browser.size(size)
                for theme in THEMES if PICTURES else (LOOKED_AT.get(size, "dark"),):
                    with self.subTest(page, size=size, theme=theme):
                        self.browser.theme(theme)
                        self.keep_picture(page, width, theme)
                        self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), width)
                        if script and LOOKED_AT.get(size) == theme:
                            self.assert_axe_finds_nothing()
        self.browser.theme("auto")

    def keep_picture(self, page, width, theme):
        if PICTURES:
            os.makedirs(PICTURES, exist_ok=True)
            self.browser.run_later("requestAnimationFrame(() => requestAnimationFrame(() => done(1)))")
            self.browser.picture(Path(PICTURES) / f"{page.split('=')[0].replace('/', '_')}_{width}_{theme}.png")

    def test_the_theme_stays_and_changes_the_ground(self):
        self.open()
        grounds = set()
        for theme in THEMES:
            self.browser.theme(theme)
            grounds.add(self.browser.run("return getComputedStyle(document.body).backgroundColor"))
        self.assertEqual(len(grounds), 2)
        self.browser.driver.refresh()
        self.browser.until("it is dark still", lambda: self.browser.run("return document.documentElement.dataset.theme") == "dark")
        self.browser.press("#theme")
        self.assertEqual(self.browser.run("return window.axisgateTheme.chosen()"), "auto")

    def test_all_is_reached_by_keyboard(self):
        self.open()
        self.browser.key(Keys.TAB)
        self.assertEqual(self.browser.focused().get_attribute("id"), "skip")
        self.browser.key(Keys.ENTER)
        self.assertEqual(self.browser.focused().get_attribute("id"), "content")
        self.assertEqual(self.browser.run("return location.hash.replace('#', '')"), "")
        seen = []
        for _ in range(40):
            self.browser.key(Keys.TAB)
            seen.append(self.browser.run("return (document.activeElement.textContent || document.activeElement.id).trim()"))
            if seen[-1] == "lift":
                break
            outline = self.browser.run("return getComputedStyle(document.activeElement).outlineStyle")
            self.assertNotEqual(outline, "none", seen[-1])
        self.assertIn("Worst first", seen)
        self.assertEqual(seen[-1], "lift")
        self.browser.key(Keys.ENTER)
        self.browser.until_text("h1", "1  lift")
        self.browser.until("the heading has the focus", lambda: self.browser.focused().tag_name == "h1")

    def test_a_heading_sorts_and_says_so(self):
        self.open()
        self.browser.until("all lines", lambda: len(self.browser.texts(".axes tbody tr")) == 6)
        heading = ".axes th.name .sort"
        self.browser.element(heading).send_keys(Keys.ENTER)
        self.assertEqual(self.browser.attributes(".axes thead th.name", "aria-sort"), ["ascending"])
        self.browser.until("by name", lambda: self.browser.texts(".axes tbody .name") == sorted(NAMES.values()))
        self.browser.element(heading).send_keys(Keys.SPACE)
        self.assertEqual(self.browser.attributes(".axes thead th.name", "aria-sort"), ["descending"])

    def test_a_hidden_page_holds_no_stream(self):
        self.open()
        streams = lambda: self.cell.get("api/v1/gateway")["web"]["streams"]
        self.browser.until("one stream", lambda: streams() == 1)
        hide = "Object.defineProperty(document, 'visibilityState', {value: arguments[0], configurable: true}); document.dispatchEvent(new Event('visibilitychange'))"
        self.browser.run(hide, "hidden")
        self.browser.until("no stream", lambda: streams() == 0)
        self.assertEqual(self.browser.texts("#not-seen"), [])
        self.browser.run(hide, "visible")
        self.browser.until("it lives again", self.lives)

    def test_all_files_together_weigh_little(self):
        folder = Path(SOURCE) / "gateway/upstream/web_process/pages"
        files = [str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()] + ["lib/dygraph.min.js"]
        self.assertGreater(len(files), 20)
        answers = {name: self.cell.fetch(name, **{"Accept-Encoding": "gzip"}) for name in files}
        self.assertEqual([name for name, (status, _, _) in answers.items() if status != 200], [])
        self.assertLess(sum(size for _, _, size in answers.values()), WEIGHT)

    def test_frames_are_put_together_as_they_are_meant(self):
        """What the stream may do to a page, told without a gateway: cut anywhere, merged, a drive that is no more."""
        self.open()
        found = json.loads(self.browser.run_later("""
          const {FrameReader} = await import('./stream.js');
          const {Store} = await import('./state/store.js');
          const frames = [];
          const reader = new FrameReader((kind, data, id) => frames.push([kind, data, id]));
          for (const piece of ['eve', 'nt: a\\r\\nda', 'ta: 1\\n', 'data: 2\\n\\n: alive\\n\\nid: 7.1\\nevent: b\\ndata:3\\n', '\\n', 'data: not whole']) reader.take(piece);
          const store = new Store();
          const axis = (number, more) => ({axis: number, values: {}, last: {}, ...more});
          store.take('hello', {boot: '7'}, null, 0);
          store.take('axes', {at: 't', joined: true, axes: [axis(1, {values: {a: 1, b: 2}, alarms: [1, 2], fault: {code: 1, text: 'x'}})]}, null, 0);
          store.take('axes', {at: 't', joined: true, axes: [axis(2, {})]}, null, 0);
          store.take('gateway', {name: 'g'}, null, 0);
          store.take('axes', {at: 'u', joined: true, axes: [{axis: 1, values: {a: null}, last: {a: {value: 1, age_ms: 5}}, alarms: [], fault: null}]}, null, 1);
          const merged = JSON.parse(JSON.stringify(store.axes.get(1)));
          for (const number of [2, 1, 2]) store.take('event', {id: `7.${number}`, number}, null, 2);
          const events = store.events.map(e => e.number);
          store.take('hello', {boot: '8'}, null, 3);
          store.take('axes', {at: 'v', joined: true, axes: [axis(2, {})]}, null, 3);
          store.take('gateway', {name: 'g'}, null, 3);
          done(JSON.stringify({frames, merged, events, axes: [...store.axes.keys()], left: store.events.length}));
        """))
        self.assertEqual(found["frames"], [["a", "1\n2", None], ["b", "3", "7.1"]])
        self.assertEqual(found["merged"], {"axis": 1, "values": {"a": None, "b": 2}, "last": {"a": {"value": 1, "age_ms": 5}}, "alarms": [], "fault": None, "taken": 1})
        self.assertEqual(found["events"], [1, 2])
        self.assertEqual((found["axes"], found["left"]), ([2], 0), "another start of the gateway: other axes, other events")

    def test_numbers_are_written_as_an_instrument_does(self):
        self.open()
        found = json.loads(self.browser.run_later("""
          const f = await import('./format.js');
          done(JSON.stringify([f.value_text('position_rev', -0.00001), f.value_text('velocity_rpm', -12345.67), f.value_text('statusword', 0x237), f.value_text('current_a', null),
            f.told('homing_speed_zero_rpm'), f.told('something_new_v'), f.duration(1234), f.duration(125000), f.uptime(90061), f.number(1234567), f.hex(-1, 8)]));
        """))
        self.assertEqual(found, ["0.0000", "−12\u202f345.7", "0x0237", "–", ["Homing speed zero", "rpm", 1], ["Something new", "V", 1], "1.2 s", "2 min", "1 d 01:01:01",
                                 "1\u202f234\u202f567", "0xFFFFFFFF"])


class Refused(PageStory):
    """A page that gets no stream, of a gateway that is open to others: both stand on each page."""

    web = {"host": "0.0.0.0", "max_streams": 2, "insecure": True, "allow": [{"from": "127.0.0.1/32"}]}

    def test_it_says_that_it_is_refused_and_why_and_goes_on_by_itself(self):
        others = [self.cell.open_stream() for _ in range(2)]
        self.browser.go(self.cell.address)
        self.browser.until_text("#not-seen", "503")
        for other in others:
            other.close()
        self.browser.until("it lives", self.lives)

    def test_each_page_says_that_it_is_not_encrypted(self):
        for page in PAGES:
            with self.subTest(page):
                self.open(page)
                self.browser.until_text("#strips", "Not encrypted")


if __name__ == "__main__":
    main()
