# SPDX-License-Identifier: Apache-2.0
"""axis_command: a DDS writer of either vendor does what a Modbus client can. What is refused, repeated or malformed is told by
tests/unit/dds and tests/dds_process."""
import time

from dds_stage import COMMAND, CYCLONE, DONE, RPM, STATE_UNSUITABLE, TURN, VENDORS, DdsStory, main
from lease_stage import NOBODY
from modbus import ABORTED, ACTIVE, COMPLETED, CONTINUOUS, DISCRETE, STANDSTILL, STOPPING
from processes import until

UNITS = 10000  # of a turn


class Commanded(DdsStory):
    def setUp(self):
        super().setUp()
        self.begin()

    def each_axis_of_each_vendor(self):
        for vendor in VENDORS:
            peer = self.commander(vendor)
            for number in self.numbers:
                self.at = f"{vendor}, axis {number}"
                yield peer, number, self.watched(number)
                self.let_go(peer, number)
                self.watched(number).until(owner=NOBODY)
        self.at = None

    def arrive(self, axis, position, request):
        axis.until(motion_state=COMPLETED, motion_id=request & 0xFFFF)
        until("it is there", lambda: abs(axis.get("position_actual") - position) <= 20)


class Motion(Commanded):
    def test_moves_runs_and_stops(self):
        for peer, number, axis in self.each_axis_of_each_vendor():
            self.prepare_by_dds(peer, number)
            peer.do(number, "enable")
            axis.until(axis_state=STANDSTILL)
            here = axis.get("position_actual")
            first = 0x10000 * number + next(peer.ids)  # more than a register can show of it
            self.assertEqual(peer.answer(peer.ask(number, "move_absolute", first, target_position=TURN * (here + 2 * UNITS) / UNITS,
                                                  profile_velocity=600 * RPM)), (DONE, 0))
            self.arrive(axis, here + 2 * UNITS, first)
            second = peer.ask(number, "move_relative", target_position=-TURN / 2)
            self.assertEqual(peer.answer(second)[0], DONE)
            self.arrive(axis, here + 3 * UNITS // 2, second)
            peer.do(number, "run_velocity", target_velocity=200 * RPM)
            axis.until(axis_state=CONTINUOUS)
            self.until_it_turns_at(number, 200)
            peer.do(number, target_velocity=-100 * RPM)  # alone, while it runs
            self.until_it_turns_at(number, -100)
            peer.do(number, "halt")
            self.until_it_stands(number)
            axis.until(motion_state=ABORTED, axis_state=STANDSTILL if number == 2 else axis.get("axis_state"))
            peer.do(number, "enable")
            peer.do(number, "move_absolute", target_position=TURN * 5000)
            axis.until(axis_state=DISCRETE, motion_state=ACTIVE)
            peer.do(number, "quick_stop")
            self.until_it_stands(number)
            axis.until(axis_state=STOPPING)
            self.assertEqual(peer.do(number, "run_velocity", wanted=STATE_UNSUITABLE), 0x08000022)
            peer.do(number, "enable")
            axis.until(axis_state=STANDSTILL)


class Jog(Commanded):
    axis_options = {"jog_timeout_ms": 600}

    def test_a_motor_jogs_while_its_command_comes_again(self):
        for peer, number, axis in self.each_axis_of_each_vendor():
            self.prepare_by_dds(peer, number)
            peer.do(number, "enable")
            for name, sign in (("jog_forward", 1), ("jog_reverse", -1)):
                def turns(peer=peer, number=number, name=name, sign=sign):
                    peer.ask(number, name, jog_velocity=200 * RPM)
                    return self.speed(number) * sign > 0

                until(f"{name} turns", turns)
                end = time.monotonic() + 0.9
                while time.monotonic() < end:
                    request = peer.ask(number, name, jog_velocity=200 * RPM)
                    self.assertEqual(peer.answer(request)[0], DONE)
                    self.assertGreater(self.speed(number) * sign, 0)
                peer.do(number, "jog_end")
                self.until_it_stands(number)
            until("it jogs", lambda peer=peer, number=number: peer.ask(number, "jog_forward") and self.speed(number) != 0)
            self.until_it_stands(number)  # nobody says so any more
            self.assertIn("enabled", axis.inputs())


class LastOfItsInstance(Commanded):
    lines_of = ("serial",)

    def test_its_data_count_as_those_of_any_other_sample(self):
        peer = self.commander(CYCLONE)
        self.run_by_dds(peer, 1)
        for command in ("quick_stop", "disable", "enable"):
            self.at = command
            request = peer.write("axis_command", verb="writedispose", axis=1, command=COMMAND[command])
            self.assert_one_answer(peer, request, DONE)
        self.watched(1).until(axis_state=STANDSTILL)
        self.let_go(peer, 1)


class Malformed(Commanded):

    def test_bytes_that_are_no_command_hurt_nobody(self):
        """Sent as the payload of a sample: too short, too long, no encapsulation, nonsense."""
        odd = self.peer_of("fast")
        odd.writer("axis_command", "raw")
        good = self.commander("cyclone")
        process = self.dds_process()
        for payload in ("00010000", "00010000 0100".replace(" ", ""), "ff" * 64, "0001000001000000" + "00" * 4000, "0003000001000000" * 9,
                        "00", "00010000" + "ff" * 104):
            odd.write("axis_command", payload=payload)
            good.do(1, profile_velocity=100 * RPM)
        self.assertEqual(self.dds_process(), process, "it goes on")
        self.assertEqual(self.speed(1), 0)


if __name__ == "__main__":
    main()
