# SPDX-License-Identifier: Apache-2.0
"""Scope and captures as a person uses them: two drives of two makers on one time line, what was before a fault."""
import csv
import json
from datetime import datetime

from web_stage import PageStory, main  # first: it knows where the others' modules are

from axe import axe_core
from browser import Keys, THEMES


class Scope(PageStory):
    web = {"captures": {"before_s": 2, "after_s": 0}}

    def test_a_trigger_holds_the_sample_that_crosses_on_drives_of_two_makers(self):
        self.open("scope/s=1.velocity_rpm,5.velocity_rpm/w=0.5/t=1.velocity_rpm,rising,30,20,single,0")
        self.browser.until("both are drawn", lambda: self.browser.texts(".tags .tag") == ["A", "B"] or self.browser.texts(".tags .tag") == ["B", "A"])
        self.assertEqual([text.split()[:3] for text in self.browser.texts(".legend tbody th")], [["A", "1", "lift"], ["B", "5", "left"]])
        self.browser.press("#arm")
        self.browser.until_text("#trigger-state", "Waiting")
        self.addCleanup(self.cell.rest, 1)
        self.cell.run(1, 60)
        self.browser.until_text("#trigger-state", "Held")
        self.browser.until_text(".where", "Held by the trigger")
        rows = self.csv_of_the_plot()
        crossed = next(at for at, value in rows if value >= 30)
        self.assertLess(rows[0][1], 30, "what was before it is seen")
        begin, end = self.browser.until("the address has it", lambda: self.browser.run("const f = location.hash.match(/from=([0-9.]+).to=([0-9.]+)/); return f && f.slice(1).map(Number)"))
        self.assertAlmostEqual(begin + 0.2 * (end - begin), crossed, delta=0.002)
        self.browser.element(".over").send_keys(Keys.HOME)
        self.browser.until_text(".where", "Paused")
        self.browser.element(".over").send_keys(Keys.END)
        self.browser.until_text(".where", "Live")
        self.assertEqual(self.browser.complaints(), [])

    def csv_of_the_plot(self):
        """(ms since 1970, velocity) of the first line, by the page's own link."""
        status, body, _ = self.cell.fetch(self.browser.element("#csv").get_attribute("href").removeprefix(self.cell.address))
        self.assertEqual(status, 200)
        rows = list(csv.reader(body.decode().splitlines()))
        self.assertEqual(rows[0][:2], ["time", "1.velocity_rpm"])
        return [(datetime.fromisoformat(row[0].replace("Z", "+00:00")).timestamp() * 1000, float(row[1])) for row in rows[1:] if row[1]]

    def test_a_fault_is_kept_with_the_motion_before_it(self):
        self.addCleanup(self.heal)
        self.cell.run(1, 60)
        self.open("axis/1")
        self.browser.until("it turns", lambda: any(text.startswith(("59", "60", "61")) for text in self.browser.texts("[data-name=velocity_rpm] .figure")))
        self.cell.sim.ask("fault lift/1 2601 0x0020")
        self.browser.until("its capture can be opened", lambda: self.browser.texts("#before"))
        self.browser.press("#before")
        self.browser.until_text("h1", "Fault: 1 lift")
        self.browser.until_text(".states", "kept")
        row = self.browser.until("its velocity", lambda: self.browser.texts("[data-key='1.velocity_rpm'] td.extra"))
        self.assertGreater(float(row[1]), 50, "how fast it was before")
        self.browser.until_text(".instant[data-tone=act]", "Fault")
        self.assertIn("run_velocity", self.browser.text(".events"), "who had moved it")
        if script := axe_core():
            self.browser.run(script)
            for theme in THEMES:
                self.browser.theme(theme)
                self.assert_axe_finds_nothing()
            self.browser.theme("auto")
        self.move_to("captures")
        self.browser.until_text(".captures tbody tr:first-child", "Fault")
        self.browser.until_text(".captures tbody tr:first-child", "complete")

    def heal(self):
        self.cell.sim.ask("clear lift/1 2601 0x0020")
        self.cell.fresh().calm()

    def test_the_scope_is_worked_by_keyboard_alone(self):
        self.open("scope")
        self.tab_to("Search what can be drawn")
        self.browser.key("lift velocity rpm")
        self.browser.until("it is found", lambda: "1 lift" in self.browser.text(".choices li:first-child"))
        self.browser.key(Keys.TAB, Keys.SPACE)
        self.browser.until("it is drawn", lambda: self.browser.texts(".tags .tag") == ["A"])
        self.tab_to("Plot.", back=True)
        self.browser.key(Keys.SPACE)
        self.browser.until_text(".where", "Paused")
        self.browser.key("+")
        self.browser.until_text(".where", "6.667 s")
        self.browser.key("c")
        self.tab_to("Cursor X1")
        before = int(self.browser.focused().get_attribute("aria-valuenow"))
        self.browser.key(Keys.PAGE_UP)
        self.browser.until("it has moved", lambda: int(self.browser.focused().get_attribute("aria-valuenow")) > before)
        self.assertIn("X2 − X1", self.browser.text(".apart"))
        self.tab_to("Take away axis 1")
        self.browser.key(Keys.ENTER)
        self.browser.until_text(".empty", "Nothing is chosen")

    def tab_to(self, label, back=False):
        for _ in range(60):
            self.browser.key(*([Keys.SHIFT, Keys.TAB] if back else [Keys.TAB]))
            if (self.browser.focused().get_attribute("aria-label") or "").startswith(label):
                return
        self.fail(f"Tab never comes to '{label}'")

    def test_what_a_scope_decides_it_decides_by_samples(self):
        """Trigger, columns of a picture, cursors, addresses: told without a gateway, by sequences."""
        self.open("about")
        found = json.loads(self.browser.run_later("""
          const {Trigger, crosses} = await import('./state/trigger.js');
          const {Samples, of_slices} = await import('./state/samples.js');
          const {rows_of} = await import('./state/columns.js');
          const {Recording} = await import('./state/recording.js');
          const {between} = await import('./state/cursors.js');
          const {from_words, to_hash} = await import('./state/scope_link.js');
          const {bounded, zoomed} = await import('./state/view.js');
          const {range} = await import('./state/scale.js');
          const {holds} = await import('./state/series.js');
          const {utc_ms, utc_text} = await import('./state/utc.js');
          const fired = (wanted, samples, span = 10) => {
            const trigger = new Trigger({position: 0.5, again: true, hold_off_ms: 0, ...wanted}, span);
            const at = [];
            for (const [time, value] of samples) { const before = trigger.count; trigger.take(time, value); if (trigger.count > before) at.push(time); }
            return [at, trigger.state, trigger.shown];
          };
          const rising = {kind: 'rising', level: 10};
          const triggers = {
            crosses: fired(rising, [[0, 9], [1, 11]]),
            exactly: fired(rising, [[0, 9], [1, 10], [2, 10], [3, 11]]),
            from_exactly: fired(rising, [[0, 10], [1, 11]]),
            gap: fired(rising, [[0, 9], [1, null], [2, 11], [3, 9], [4, 12]]),
            falling: fired({kind: 'falling', level: 10}, [[0, 9], [1, 11], [2, 10], [3, 9]]),
            above: fired({kind: 'above', level: 10}, [[0, null], [1, 11]]),
            bit: fired({kind: 'bit_set', level: 5}, [[0, 32], [1, 0], [2, 33]]),
            no_bit: fired({kind: 'bit_clear', level: 31}, [[0, 2147483648], [1, 0]]),
            again: fired(rising, [[0, 9], [1, 11], [2, 9], [3, 11], [6, 9], [7, 11], [20, 9], [21, 11]]),
            hold_off: fired({...rising, hold_off_ms: 20}, [[0, 9], [1, 11], [7, 9], [8, 11], [20, 9], [21, 11]]),
            single: fired({...rising, again: false}, [[0, 9], [1, 11], [6, 9], [7, 11]]),
            at_begin: fired({...rising, again: false, position: 0}, [[0, 9], [1, 11], [11, 9]]),
            at_end: fired({...rising, again: false, position: 1}, [[0, 9], [1, 11], [2, 9]]),
          };
          const line = new Samples();
          for (let t = 0; t < 1000; ++t) line.push(t, t === 500 ? 99 : t < 200 ? 0 : 1);
          line.push(1000, null); line.push(1100, 5); line.push(1050, 7);
          const rows = rows_of([{samples: line, holds: false}], 100.5, 1200, 20);
          const values = rows.map(row => row[1]);
          const sparse = rows_of([{samples: of_slices([[0, 0, 0], [100, 10, 10]]), holds: false}, {samples: of_slices([[0, 1, 1], [100, 2, 2]]), holds: true}], 50, 150, 10);
          const full = new Samples();
          for (let t = 0; t < 200000; ++t) full.push(t, t);
          const recording = new Recording();
          recording.begin(['1.a']);
          recording.take({from: '2026-01-01T00:00:10.000000Z', series: {'1.a': [[0.5, 2], [10, 3]], '2.b': [[0, 1]]}}, () => {});
          recording.take_past({oldest: '2026-01-01T00:00:00.000000Z', series: {'1.a': [['2026-01-01T00:00:05.000000Z', 0, 1], ['2026-01-01T00:00:10.000500Z', 9, 9]]}});
          const told = recording.lines.get('1.a');
          done(JSON.stringify({triggers, highest: Math.max(...values.filter(v => v !== null && !Number.isNaN(v))), gap: rows.filter(row => Number.isNaN(row[1])).length,
            gap_at: rows.find(row => Number.isNaN(row[1]))[0] - 1000, sorted: rows.every((row, i) => i === 0 || rows[i - 1][0] <= row[0]), sparse, bound: full.length <= 80000 && full.last === 199999,
            told: [told.values, recording.covers({from: utc_ms('2026-01-01T00:00:06Z'), to: utc_ms('2026-01-01T00:00:10Z')}), recording.covers({from: 0, to: 1})],
            cursors: between(told, [utc_ms('2026-01-01T00:00:05.000000Z'), utc_ms('2026-01-01T00:00:11Z')], false),
            nothing: between(line, [1050, -1], false),
            link: to_hash(from_words(['s=1.velocity_rpm,9.x,2.position_rev,1.velocity_rpm,01.a,a.b', 'w=2', 't=1.velocity_rpm,bit_set,3,40,repeat,0', 'from=1000', 'to=2000'])),
            nearly: to_hash(from_words(['s=', 'w=0', 't=1.velocity_rpm,bit_set,3.5,40,repeat', 'from=5', 'to=4', 'x'])),
            views: [bounded({from: 0, to: 100}, 50, 120), zoomed({from: 0, to: 100}, 25, 0.5)], ranges: [range([0, 10], [1, 9], 1), range([0, 10], [4, 5], 1), range(null, [5, 5], 2)],
            utc: [utc_text(utc_ms('2026-01-01T00:00:10.123456Z')), Number.isNaN(utc_ms('yesterday')), crosses({kind: 'rising', level: 0}, null, 1)],
            holds: ['velocity_rpm', 'target_velocity_rpm', 'axis_state', 'position_rev', 'position_limit_min_rev'].filter(holds)}));
        """))
        fired = {name: at for name, (at, _, _) in found["triggers"].items()}
        self.assertEqual(fired, {"crosses": [1], "exactly": [1], "from_exactly": [], "gap": [4], "falling": [2], "above": [1], "bit": [2], "no_bit": [1], "again": [1, 7, 21],
                                 "hold_off": [1, 21], "single": [1], "at_begin": [1], "at_end": [1]})
        states = {name: (state, shown) for name, (_, state, shown) in found["triggers"].items()}
        self.assertEqual(states["single"], ("done", {"at": 1, "from": -4, "to": 6}))
        self.assertEqual(states["at_begin"], ("done", {"at": 1, "from": 1, "to": 11}))
        self.assertEqual(states["at_end"], ("done", {"at": 1, "from": -9, "to": 1}))
        self.assertEqual(states["crosses"][0], "filling", "what comes behind it is not here yet")
        self.assertEqual((found["highest"], found["gap"], found["sorted"], found["bound"]), (99, 1, True, True), "a spike of one sample, one gap")
        self.assertLess(abs(found["gap_at"]), 2 * 1100 / 20)
        self.assertEqual([row[1:] for row in found["sparse"]], [[5, 1], [10, 2]], "a number runs on between two samples, a code holds")
        self.assertEqual(found["told"], [[0, 1, 2, 3], True, False], "the stream's own samples stand above the history's")
        self.assertEqual((found["cursors"], found["nothing"]), ({"first": 1, "second": 3, "difference": 2}, {"first": None, "second": None, "difference": None}))
        self.assertEqual((found["link"], found["nearly"]), ("#scope/s=1.velocity_rpm,9.x,2.position_rev/w=2/t=1.velocity_rpm,bit_set,3,40,repeat,0/from=1000.000/to=2000.000", "#scope"))
        self.assertEqual(found["views"], [{"from": 20, "to": 120}, {"from": 12.5, "to": 62.5}])
        self.assertEqual(found["ranges"], [[0, 10], [3.92, 5.08], [3.84, 6.16]])
        self.assertEqual(found["holds"], ["target_velocity_rpm", "axis_state", "position_limit_min_rev"], "what is set has no ramp")
        self.assertEqual(found["utc"], ["2026-01-01T00:00:10.123456Z", True, False])


if __name__ == "__main__":
    main()
