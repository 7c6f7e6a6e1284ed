# SPDX-License-Identifier: Apache-2.0
"""axis_command: a DDS writer of either vendor does all that a Modbus client can, gets one reply each time, and can ask nothing twice."""
import time

from dds_stage import (BAD_VALUE, COMMAND, CYCLONE, DONE, NO_AXIS, NOT_SUPPORTED, RPM, SEEN, STATE_UNSUITABLE, TURN, VENDORS,
                       DdsStory, main)
from lease_stage import NOBODY
from modbus import (ABORTED, ACTIVE, COMPLETED, CONTINUOUS, DISABLED, DISCRETE, ERROR_STOP, STANDSTILL, STOPPING, Axis)
from processes import until

UNITS = 10000  # of a turn
HERE = 35  # homing method: this place is zero
FAULTS = {"serial": "2601 0x0100", "leadshine": "0x0210"}


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

    def test_homing_torque_and_a_new_zero(self):
        engineer = self.peer()
        limited = Axis(engineer, 2)
        limited.set(max_velocity=500_000)
        limited.command("release")
        for peer, number, axis in self.each_axis_of_each_vendor():
            self.prepare_by_dds(peer, number)
            peer.do(number, "enable")
            request = peer.ask(number, "move_relative", target_position=TURN, profile_velocity=600 * RPM)
            peer.answer(request)
            axis.until(motion_state=COMPLETED, motion_id=request)
            request = peer.ask(number, "home", homing_method=HERE)
            self.assertEqual(peer.answer(request)[0], DONE)
            self.arrive(axis, 0, request)
            axis.until_input("homed")
            request = peer.ask(number, "move_absolute", target_position=TURN)
            peer.answer(request)
            self.arrive(axis, UNITS, request)
            axis.until_input("moving", False)
            if axis.get("supported_commands") >> COMMAND["set_position"] & 1:
                peer.do(number, "set_position", set_position_value=0)
                until("position 0", lambda axis=axis: abs(axis.get("position_actual")) <= 20)
            if number == 2:
                peer.do(number, "run_torque", target_torque=100)
                axis.until(mode_display=4)
                self.until_it_turns(number)
                peer.do(number, "halt")
                self.until_it_stands(number)

    def test_faults_are_reset_and_parameters_saved(self):
        for peer, number, axis in self.each_axis_of_each_vendor():
            line = self.motors[number][0]
            stores = int(self.sim.ask(f"stores {line}/1"))
            peer.do(number, "save_parameters")
            until("stored", lambda line=line, stores=stores: int(self.sim.ask(f"stores {line}/1")) > stores)
            peer.do(number, "enable")
            self.sim.ask(f"fault {line}/1 {FAULTS[line]}")
            axis.until(axis_state=ERROR_STOP)
            peer.do(number, "enable", wanted=STATE_UNSUITABLE)
            self.sim.ask(f"clear {line}/1 {FAULTS[line]}")
            peer.do(number, "fault_reset")
            axis.until(axis_state=DISABLED, error_code=0)

    def test_what_a_drive_cannot_do_is_not_supported(self):
        for peer, number, axis in self.each_axis_of_each_vendor():
            supported = axis.get("supported_commands")
            missing = [name for name, code in COMMAND.items() if 1 <= code <= 12 and not supported >> code & 1]
            for name in missing:
                peer.do(number, name, wanted=NOT_SUPPORTED)


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


class Once(Commanded):
    def test_a_request_that_comes_again_is_answered_and_not_run_again(self):
        for peer, number, axis in self.each_axis_of_each_vendor():
            self.prepare_by_dds(peer, number)
            peer.do(number, "enable")
            here = axis.get("position_actual")
            asked = {"target_position": TURN, "profile_velocity": 600 * RPM}
            request = peer.ask(number, "move_relative", **asked)
            self.assertEqual(peer.answer(request)[0], DONE)
            self.arrive(axis, here + UNITS, request)
            since = peer.now()
            for _ in range(3):
                peer.ask(number, "move_relative", request, **asked)
            until("each is answered", lambda peer=peer, request=request, since=since: len(peer.answers(request, since)) >= 3)
            self.assertEqual([reply["result"] for reply in peer.answers(request)], [DONE, SEEN, SEEN, SEEN])
            # Another request after it proves that nothing of the repeated ones is still to come.
            peer.do(number, "halt")
            self.assertAlmostEqual(axis.get("position_actual"), here + UNITS, delta=20)
            self.assertEqual(axis.get("motion_id"), request)

    def test_each_of_many_requests_has_one_reply(self):
        for vendor in self.each_vendor():
            peer = self.commander(vendor)
            asked = [peer.ask(1 + i % 2, profile_velocity=(100 + i) * RPM) for i in range(100)]
            for number in asked:
                peer.answer(number)
            peer.do(peer.nowhere, "enable", wanted=NO_AXIS)
            for number in asked:
                self.assertEqual(len(peer.answers(number)), 1, f"request {number}")
            self.assertEqual(peer.answers(asked[-1])[0]["result"], DONE)
            for number in self.numbers:
                peer.do(number, "release")


class Malformed(Commanded):
    def test_what_makes_no_sense_is_refused_and_moves_nothing(self):
        wrong = [("no request id", {"request_id": 0, "command": COMMAND["move_relative"], "mask": 2, "target_position": 9}, BAD_VALUE),
                 ("an unknown command", {"command": 15}, BAD_VALUE), ("an unknown command", {"command": 255}, BAD_VALUE),
                 ("a mask of nothing", {"command": 0}, BAD_VALUE),
                 ("an unknown bit of the mask", {"command": 8, "mask": 0x80000004, "target_velocity": 9}, BAD_VALUE),
                 ("a full mask", {"command": 8, "mask": 0xFFFFFFFF, "target_velocity": 9}, BAD_VALUE),
                 ("no number", {"command": 8, "mask": 4, "target_velocity": "nan"}, BAD_VALUE),
                 ("infinity", {"command": 6, "mask": 2, "target_position": "inf"}, BAD_VALUE),
                 ("too much", {"command": 6, "mask": 2, "target_position": 1e300}, BAD_VALUE),
                 ("less than nothing", {"command": 8, "mask": 4 + 32, "target_velocity": 9, "profile_velocity": -1}, BAD_VALUE),
                 ("an unknown mode", {"command": 0, "mask": 1, "mode": 77}, BAD_VALUE),
                 ("an unknown homing method", {"command": 10, "mask": 512, "homing_method": -99}, BAD_VALUE),
                 ("a target beside a jog", {"command": 31, "mask": 2, "target_position": 9}, BAD_VALUE)]
        for peer, number, axis in self.each_axis_of_each_vendor():
            self.prepare_by_dds(peer, number)
            peer.do(number, "enable")
            axis.until(axis_state=STANDSTILL)
            before = axis.get("position_actual")
            for what, members, result in wrong:
                self.at = f"{peer.name}, axis {number}: {what}"
                since = peer.now()
                request = peer.write("axis_command", axis=number, **members)
                self.assertIn(peer.answer(request, since)[0], (result, NOT_SUPPORTED))
                self.assertEqual(self.speed(number), 0)
            for axis_number in (0, 499, 500, 65535):
                self.assertEqual(peer.answer(peer.ask(axis_number, "enable"))[0], NO_AXIS)
            self.assertEqual((axis.get("axis_state"), axis.get("position_actual")), (STANDSTILL, before))
            peer.do(number, "run_velocity", target_velocity=100 * RPM)
            self.until_it_turns(number)

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


class NotRead(Commanded):
    def assert_commands_are_not_read(self):
        for vendor in self.each_vendor():
            peer = self.peer_of(vendor).read("axis_state")
            peer.sample("axis_state", axis=1)
            for topic in ("axis_command", "object_request"):
                peer.say("writer", topic)
                peer.wait("writer", topic)
            late = self.peer_of(vendor).read("axis_state")  # discovery goes on
            late.sample("axis_state", axis=1)
            for topic in ("axis_command", "object_request"):
                self.assertEqual(peer.all("matched", topic), [])


class SwitchedOff(NotRead):
    dds = {"commands": False}

    def test_commands_are_not_even_read(self):
        self.assert_commands_are_not_read()


class ByDefault(NotRead):
    """Nobody has said anything of commands."""

    dds = {"commands": None}

    def test_commands_are_off(self):
        self.assert_commands_are_not_read()


if __name__ == "__main__":
    main()
