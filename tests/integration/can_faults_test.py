# SPDX-License-Identifier: Apache-2.0
"""One device of a CAN bus floods it, doubles, refuses or restarts: the others go on, and nothing is enabled. Late replies are told in
drive_faults_test.py, the rest of it by CanDrive, CanNodeState and EachSdoFails of tests/unit/drive."""
import re
import time

from can_stage import FAR, CanStory, main
from modbus import BUSY, DISABLED, FAILED, NO_ANSWER, ONLINE, REFUSED, STANDSTILL
from processes import until

DUPLICATE_NODE, IDENTITY_MISMATCH = 1 << 8, 1 << 2
LEADSHINE, KINCO = 0x4321, 0x300
REFUSED_BY_DRIVE = 3
OUT_OF_RANGE = 0x06090030


class OneOfThree(CanStory):
    def setUp(self):
        super().setUp()
        self.begin()
        for axis in self.axes:
            self.prepare(axis)
        self.middle, self.others = self.axes[1], [self.axes[0], self.axes[2]]

    def healed(self, number=2):
        self.ask("clear DRIVE", number)
        self.axes[number - 1].until(link_state=ONLINE)

    def told(self, pattern):
        return len(self.gateway.found(pattern))


class Storms(OneOfThree):
    def test_a_storm_of_emergencies_is_told_in_few_words(self):
        self.ask("emergencies DRIVE 0x2310 on", 2)
        self.gateway.wait_for("axis 2: EMCY 0x2310")
        overviews = 0

        def stormy():
            nonlocal overviews
            for axis in self.axes:
                self.assertEqual(self.client.overview(axis.number)["link_state"], ONLINE)
                overviews += 1
            return self.client.bus(0)["bad_frames"] >= 300 and overviews >= 300

        until("a storm", stormy)
        self.assert_goes_on(*self.others)
        self.assertEqual(self.ask("nmt DRIVE", 2), "operational")
        self.ask("clear DRIVE", 2)
        lines = self.gateway.found("axis 2: EMCY 0x2310")
        left_out = sum(int(found[1]) for line in lines if (found := re.search(r"\((\d+) more were left out\)", line.string)))
        self.assertGreater(left_out, 0)
        self.assertGreater(left_out + self.client.bus(0)["bad_frames"], 10 * len(lines), "each is told by itself")
        self.assertEqual(self.told("axis [13]: EMCY"), 0)
        self.assertEqual(self.told("axis 2: floods the bus with frames 0x082"), 1)
        self.middle.until(link_state=ONLINE)
        self.move(self.middle)
        self.assert_one_request_at_a_time()

    def test_a_babbling_heartbeat_is_named(self):
        self.ask("babble DRIVE on", 2)
        self.gateway.wait_for("axis 2: floods the bus with frames 0x702")
        self.assert_goes_on(*self.others)
        self.healed()
        self.let_heartbeats_pass()
        until("it can be used", lambda: "ready" in self.middle.inputs())
        self.move(self.middle)
        self.assert_one_request_at_a_time()


class TwoBuses(CanStory):
    drives_on = {"loud": "ld2@1,jd@2", "calm": "md@1,ld2@2"}

    def test_the_calm_bus_keeps_its_cycle(self):
        self.begin()
        calm = self.axes[2:]
        for axis in self.axes:
            self.prepare(axis)
        before = self.client.bus(1)
        for number, word in ((1, "babble DRIVE on"), (2, "emergencies DRIVE 0x1000 on")):
            self.ask(word, number, "loud")
        until("much noise", lambda: self.client.bus(0)["bad_frames"] >= 200)
        for _ in range(3):
            self.assert_goes_on(*calm)
        after = self.client.bus(1)
        for name in ("timeouts", "late_replies", "bad_frames"):
            self.assertEqual(after[name], before[name], name)
        self.assertGreater(after["replies"], before["replies"])
        self.assertEqual(after["link"], 1)
        for number in (1, 2):
            self.ask("clear DRIVE", number, "loud")
        self.let_heartbeats_pass()
        for axis in self.axes:
            axis.until(link_state=ONLINE)
        self.assert_goes_on(*self.axes[:2])
        self.assert_one_request_at_a_time("loud", "calm")


class DuplicateNodes(OneOfThree):
    def test_a_second_drive_with_the_same_number_is_told(self):
        for number in (1, 2, 3):
            with self.subTest(node=number):
                axis = self.axes[number - 1]
                self.assertEqual(axis.get("axis_alarms") & DUPLICATE_NODE, 0)
                self.ask("duplicate-node DRIVE on", number)
                until("the alarm", lambda: axis.get("axis_alarms") & DUPLICATE_NODE)
                self.gateway.wait_for(f"two devices answer as node {number}: give one of them another number")
                axis.until_input("warning")
                self.ask("duplicate-node DRIVE off", number)
                for other in self.axes:
                    if other is not axis:
                        self.assertEqual(other.get("axis_alarms") & DUPLICATE_NODE, 0 if other.number > number else DUPLICATE_NODE)


class AnotherDevice(CanStory):
    def buses(self):
        buses = super().buses()
        buses[0]["drives"][0]["identity"] = {"vendor": LEADSHINE, "product": 7}
        buses[0]["drives"][1]["identity"] = {"vendor": KINCO, "product": 1, "revision": 1, "serial": 1}
        return buses

    def test_it_is_shown_and_not_commanded(self):
        self.simulate()
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.look_around()
        wrong, right = self.axes[0], self.axes[1:]
        until("the alarm", lambda: wrong.get("axis_alarms") & IDENTITY_MISMATCH)
        self.assertEqual(self.client.gateway()["alarms"] >> 3 & 1, 1)
        self.gateway.wait_for("axis 1: not the configured drive: product is 0x1, configured 0x7")
        block = wrong.until(axis_state=DISABLED)
        self.assertTrue(block["valid"] >> 2 & 1, "its position is shown")
        self.assertNotIn("ready", wrong.inputs())
        self.assertEqual(self.ask("nmt DRIVE", 1), "pre_operational", "it is not started")
        self.assertEqual([self.ask(f"get DRIVE {name}", 1).split()[0] for name in ("1016.01", "1017.00")], ["0", "0"], "nor set up")
        before = [self.ask(f"writes DRIVE {name}", 1) for name in ("6040.00", "6060.00", "607A.00", "6083.00")]
        for refused in (lambda: wrong.command("enable"), lambda: wrong.set(profile_acceleration=12345), lambda: wrong.set(mode=3),
                        lambda: wrong.command("move_absolute")):
            with self.refused(BUSY):
                refused()
        self.assertEqual([self.ask(f"writes DRIVE {name}", 1) for name in ("6040.00", "6060.00", "607A.00", "6083.00")], before)
        for axis in right:
            self.assertEqual(axis.get("axis_alarms") & IDENTITY_MISMATCH, 0)
            self.prepare(axis)
            self.move(axis)


class Refusals(CanStory):
    """On an MD with rare polls the next request is the story's."""

    drives_on = {"cell": "md@1"}
    timings = {**CanStory.timings, "poll": {"fast": 60000, "normal": 60000, "slow": 600000}}

    def test_what_the_drive_refuses_comes_with_its_abort_code(self):
        self.begin()
        axis = self.axes[0]
        self.ask("exception DRIVE 0x06090030 on", 1)
        with self.refused(REFUSED):
            axis.set(profile_acceleration=12345)
        self.assertEqual((axis.get("command_result"), axis.get("command_detail")), (REFUSED_BY_DRIVE, OUT_OF_RANGE))
        with self.refused(REFUSED):
            axis.command("enable")
        self.assertEqual((axis.get("command_result"), axis.get("command_detail")), (REFUSED_BY_DRIVE, OUT_OF_RANGE))
        self.assertNotIn("enabled", axis.inputs())
        self.ask("clear DRIVE", 1)
        self.assertEqual(axis.get("link_state"), ONLINE, "a drive that refuses is there")
        axis.set(profile_acceleration=12345)
        self.assertEqual((axis.get("command_result"), axis.get("command_detail")), (2, 0))
        axis.command("enable")
        axis.until(axis_state=STANDSTILL)


class Restarts(OneOfThree):
    def test_one_that_restarts_while_it_moves_starts_nothing(self):
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                self.restart_while_it_moves(axis)

    def restart_while_it_moves(self, axis):
        others = [other for other in self.axes if other is not axis]
        for each in self.axes:
            each.command("enable")
        axis.set(target_position=FAR)
        number = axis.command("move_absolute")
        axis.until_input("moving")
        words = self.ask("writes DRIVE 6040.00", axis.number)
        self.ask("restart DRIVE", axis.number)
        self.gateway.wait_for(f"axis {axis.number}: the drive has restarted")
        axis.until(link_state=ONLINE)
        block = axis.until(motion_state=FAILED, axis_state=DISABLED)
        self.assertEqual(block["motion_id"], number)
        self.assertIn(self.ask("state DRIVE", axis.number), ("switch_on_disabled", "ready_to_switch_on"))
        self.assertLessEqual(int(self.ask("writes DRIVE 6040.00", axis.number)), int(words) + 1, "no control word but the first 6")
        with self.refused(REFUSED):
            axis.command("move_absolute")
        for other in others:
            self.assertIn("enabled", other.inputs(), "another drive's restart is no reason to stop")
            self.move(other)
        self.prepare(axis)
        self.targets[axis.number] = axis.get("position_actual")
        self.move(axis)
        until("process data again", lambda: self.ask("nmt DRIVE", axis.number) == "operational")
        self.assertEqual(self.ask("restarts DRIVE", axis.number), "1")


class InTheMiddleOfARequest(CanStory):
    """An MD alone sends its values by timer, so that with rare polls nothing but the story's requests is on the wire."""

    drives_on = {"cell": "md@1"}
    timings = {"timeout_ms": 10000, "poll": {"fast": 60000, "normal": 60000, "slow": 600000}}

    def setUp(self):
        super().setUp()
        self.begin()
        self.md = self.axes[0]
        # What is read once, and by a client's first look, has been read when the bus has become quiet.
        until("a quiet bus", self.is_quiet)

    def is_quiet(self):
        before = self.ask("writes DRIVE 6083.00", 1), self.client.bus(0)["requests"]
        mark = time.monotonic()
        until("a second", lambda: self.client.gateway() and time.monotonic() > mark + 1)
        return before == (self.ask("writes DRIVE 6083.00", 1), self.client.bus(0)["requests"])

    def restart_on_the_next_request(self, when, words):
        self.ask(f"restart DRIVE {when} next", 1)
        self.assertEqual(self.code_of(self.later(words)), NO_ANSWER)
        self.assertEqual(self.client.bus(0)["timeouts"], 0, "its start has ended the request, before its time was over")
        self.gateway.wait_for("axis 1: the drive has restarted")
        self.md.until(link_state=ONLINE, axis_state=DISABLED)

    def test_a_write_that_was_carried_out_is_not_written_again(self):
        before = int(self.ask("writes DRIVE 6083.00", 1))
        self.restart_on_the_next_request("after", lambda: self.md.set(profile_acceleration=12345))
        self.assertEqual(int(self.ask("writes DRIVE 6083.00", 1)), before + 1)

    def test_an_enable_is_not_taken_up_again(self):
        self.restart_on_the_next_request("after", lambda: self.md.command("enable"))
        self.assertIn(self.ask("state DRIVE", 1), ("switch_on_disabled", "ready_to_switch_on"))
        self.assertNotIn("enabled", self.md.inputs())
        self.md.command("enable")
        self.md.until(axis_state=STANDSTILL)


if __name__ == "__main__":
    main()
