# SPDX-License-Identifier: Apache-2.0
"""Two gateways in a domain: each does what is for it, and those of one name start nothing."""

from dds_stage import DONE, RPM, VENDORS, DdsStory, main
from lease_stage import MACHINES
from modbus import Axis
from processes import until

NAME_TAKEN = 22
ALARM_NAME_TAKEN = 1 << 13


class TwoGateways(DdsStory):
    """Each has one of the two drives, and calls it axis 1."""

    lines_of = ("serial", "modbus")

    def setUp(self):
        super().setUp()
        self.simulate({line: MACHINES[line][0] for line in self.lines_of})
        self.both = self.buses()
        for entry in self.both:
            entry["drives"][0]["axes"][0]["axis"] = 1
        self.watchers = []

    def begin_one(self, name):
        place = len(self.watchers)
        self.gateway_name = name
        self.configure(buses=[self.both[place]], name=f"gateway_{place}.json")
        self.run_gateway()
        self.client = self.peer("127.0.0.9")
        self.watchers.append(self.client)
        self.until_online()
        return self.gateway

    def enabled(self):
        """Of both."""
        return ["enabled" in Axis(watcher, 1).inputs() for watcher in self.watchers]

    def alarmed(self):
        return [bool(watcher.gateway()["alarms"] & ALARM_NAME_TAKEN) for watcher in self.watchers]


class OfTwoNames(TwoGateways):
    def test_each_does_what_is_for_it(self):
        for name in ("cell_7", "cell_8"):
            self.begin_one(name)
        for vendor in self.each_vendor():
            self.gateway_name = "cell_7"
            seventh = self.commander(vendor)
            self.gateway_name = "cell_8"
            eighth = self.commander(vendor)
            self.prepare_by_dds(seventh, 1)
            self.assert_one_answer(seventh, seventh.ask(1, "enable"), DONE)
            self.assertEqual(self.enabled(), [True, False])
            seventh.do(1, "run_velocity", target_velocity=200 * RPM)
            self.until_it_turns(1)
            self.assert_one_answer(eighth, eighth.ask(1, "quick_stop"), DONE)
            self.assertNotEqual(self.speed(1), 0, "a stop for another gateway")
            self.assertEqual(self.speed(2), 0)
            seventh.do(1, "disable")
            self.until_it_stands(1)
            seventh.do(1, "release")
            eighth.do(1, "enable")
            self.assertEqual(self.enabled(), [False, True])
            eighth.do(1, "disable")
            eighth.do(1, "release")
        self.assertEqual(self.alarmed(), [False, False])


class OfOneName(TwoGateways):
    name = "cell_7"

    def test_they_see_each_other_and_start_nothing(self):
        self.begin_one(self.name)
        masters = [self.commander(vendor, "strength", 1 + i) for i, vendor in enumerate(VENDORS)]
        self.run_by_dds(masters[0], 1)
        second = self.begin_one(self.name)
        until("both say so", lambda: all(self.alarmed()))
        self.assertNotEqual(self.speed(1), 0, "what runs goes on")
        for master in masters:
            self.assertIn(NAME_TAKEN, [reply["result"] for reply in self.all_answers(master, master.ask(1, "enable"))])
        self.assertEqual(self.enabled(), [True, False])
        masters[0].ask(1, "quick_stop")
        self.until_it_stands(1)
        second.process.terminate()
        second.ended()
        self.watchers.pop()
        until("its name is its own again", lambda: not any(self.alarmed()))
        masters[1].do(1, "enable")
        self.let_go(masters[1], 1)

    def all_answers(self, master, request):
        master.answer(request)
        return master.answers(request)


if __name__ == "__main__":
    main()
