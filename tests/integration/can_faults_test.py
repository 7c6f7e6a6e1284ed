# SPDX-License-Identifier: Apache-2.0
"""One device of a CAN bus floods it, doubles, refuses, is late or lost for words: the others go on, and nothing false is shown."""
import re

from can_stage import RPM, TURN, CanStory, main
from modbus import (ERROR_STOP, NO_ANSWER, NO_PATH, ONLINE, REFUSED, STANDSTILL, Refused)
from processes import until

DUPLICATE_NODE = 1 << 8
REFUSED_BY_DRIVE = 3
OUT_OF_RANGE = 0x06090030
# Bits of `valid`.
QUANTITY = {"position_actual": 2, "error_code": 7, "mode_display": 1, "target_position": 16, "profile_velocity": 20,
            "profile_acceleration": 21}


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


class WrongReplies(OneOfThree):
    timings = {"timeout_ms": 300}

    def stand_somewhere(self):
        """Every value of every axis differs from its neighbour's; they are known to be so."""
        self.truths = {}
        for turns, axis in enumerate(self.axes, 1):
            self.targets[axis.number] = turns * TURN // 2
            self.move(axis)
            axis.until(position_actual=self.targets[axis.number])  # a drive says "reached" a little before it stands
            axis.command("disable")
            axis.until_input("moving", False)
            axis.set(profile_velocity=(600 + turns) * RPM, profile_acceleration=30000 + 1000 * turns)
            axis.until(velocity_actual=0)
        for axis in self.axes:
            until("all is known", lambda: all(axis.block()["valid"] >> bit & 1 for bit in QUANTITY.values()))
            self.truths[axis.number] = axis.block()

    def watch_until(self, enough):
        """Reads all axes again and again; each valid value has to be the true one."""
        def look():
            for axis in self.axes:
                block = axis.block()
                for name, bit in QUANTITY.items():
                    if block["valid"] >> bit & 1:
                        self.assertEqual(block[name], self.truths[axis.number][name], f"{name} of axis {axis.number} is called valid")
            return enough(self.client.bus(0))

        until("enough of it", look)

    def test_late_replies(self):
        self.stand_somewhere()
        self.ask("late DRIVE 500 0.3", 2)
        self.watch_until(lambda now: now["late_replies"] >= 5)
        self.healed()
        self.assert_goes_on(*self.others)
        self.move(self.middle)

    def test_replies_that_come_twice(self):
        self.stand_somewhere()
        before = self.client.bus(0)["late_replies"] + self.client.bus(0)["bad_frames"]
        self.ask("duplicate DRIVE on", 2)
        self.watch_until(lambda now: now["late_replies"] + now["bad_frames"] >= before + 20)
        self.move(self.middle)
        self.healed()
        self.assert_goes_on(*self.others)

    def test_replies_of_another_node(self):
        self.stand_somewhere()
        self.ask("wrong-station DRIVE 0.2", 2)
        self.watch_until(lambda now: now["timeouts"] >= 4)
        self.healed()
        self.assert_goes_on(*self.others)

    def test_replies_that_are_too_short(self):
        self.stand_somewhere()
        before = self.client.bus(0)
        self.ask("wrong-length DRIVE 0.2", 2)
        self.watch_until(lambda now: now["bad_frames"] + now["timeouts"] >= before["bad_frames"] + before["timeouts"] + 4)
        self.healed()
        self.assert_goes_on(*self.others)
        self.move(self.middle)

    def test_lost_replies_of_writes_are_not_written_twice(self):
        for value in range(40000, 41000, 100):
            before = int(self.ask("writes DRIVE 6083.00", 2))
            self.ask("lose DRIVE 0.3", 2)
            try:
                self.middle.set(profile_acceleration=value)
                told = True
            except Refused as refused:
                told = False
                self.assertIn(refused.code, (NO_ANSWER, NO_PATH, 0x06))
            self.healed()
            written = int(self.ask("writes DRIVE 6083.00", 2)) - before
            self.assertLessEqual(written, 1)
            if told:
                self.assertEqual(written, 1)
                self.assertAlmostEqual(self.middle.get("profile_acceleration"), value, delta=50)
        self.assert_goes_on(*self.others)


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

    def test_the_drives_own_refusal_by_the_mailbox(self):
        self.begin()
        axis = self.axes[0]
        axis.client.write(axis.first + 80, 0, 0x6041, 0, 2, 0, 1)
        axis.set(object_request=2)  # a statusword cannot be written
        block = axis.until(object_status=3)
        self.assertEqual(block["object_detail"], 0x06010002)
        axis.client.write(axis.first + 81, 0x6041, 0, 2)
        axis.set(object_request=1)
        block = axis.until(object_status=2)
        self.assertEqual(block["object_data"], block["statusword"])


class DriveFaults(CanStory):
    def test_an_alarm_is_told_and_reset_and_nothing_is_enabled(self):
        self.begin()
        causes = {1: "0x2211", 2: "2601 0x0020", 3: "2601 0x0020"}
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                self.prepare(axis)
                self.move(axis)
                self.ask(f"fault DRIVE {causes[axis.number]}", axis.number)
                axis.until(axis_state=ERROR_STOP)
                until("its code", lambda: axis.get("error_code") not in (0, 0xFFFF))
                until("the drive's own word for it", lambda: axis.get("vendor_error") != 0)
                with self.refused(REFUSED):
                    axis.command("enable")
                self.ask(f"clear DRIVE {causes[axis.number]}", axis.number)
                self.reset(axis)
                self.assertNotIn("enabled", axis.inputs())
                self.move(axis)


if __name__ == "__main__":
    main()
