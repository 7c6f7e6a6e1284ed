# SPDX-License-Identifier: Apache-2.0
"""The operator's day on each drive type: enable, move, run, stop, home, disable; by registers, by coils, by raw controlword."""
from pymodbus.register_read_message import ReadWriteMultipleRegistersRequest
from pymodbus.register_write_message import MaskWriteRegisterRequest

from modbus import (ABORTED, ACTIVE, ALARM_STOP_LATCHED, AXIS, BAD_VALUE, BUSY, COMPLETED, CONTINUOUS, DISABLED, DISCRETE, NO_ADDRESS,
                    NO_ANSWER, NO_MOTION, REFUSED, STANDSTILL, MbpollFailed, Refused, encode, mbpoll)
from processes import until
from stage import Story, main

TURN = 10000
FAR = 20000 * TURN
BOTH = {1: "lift/1", 2: "feeder/1"}
COUNTS_PER_TURN = {1: 10000, 2: 65536}
RPM = 1000


class Day(Story):
    """Axis 1 is a JD, axis 2 an MD."""

    def setUp(self):
        super().setUp()
        self.start([self.listener(), self.listener(client="address")])

    def each(self):
        for number, drive in BOTH.items():
            self.programs[-1].lines.append(f"=== the story of {drive}")
            axis = self.axis(number)
            axis.set(profile_velocity=600 * RPM, profile_acceleration=30000, profile_deceleration=30000)
            yield axis, drive

    def enabled(self):
        for axis, drive in self.each():
            axis.command("enable")
            self.assertEqual(axis.get("axis_state"), STANDSTILL)
            yield axis, drive

    def assert_without_torque(self, axis, drive):
        axis.until_input("enabled", False)
        self.assertNotIn("operation", self.sim.state(drive))

    def until_moving(self, axis):
        axis.until_input("moving")

    def arrive(self, axis, target, **more):
        """The motion completes, and where the drive says so."""
        block = axis.until(motion_state=COMPLETED, **more)
        until(f"position {target}", lambda: abs(axis.get("position_actual") - target) <= 20)
        return block


class ByRegisters(Day):
    sim_options = ("--boot-ms", "5000")  # a restart is silent for longer than the gateway waits

    def test_enable_is_answered_when_the_drive_is_enabled(self):
        for axis, drive in self.each():
            axis.command("enable")
            self.assertIn("operation", self.sim.state(drive))
            block = axis.block()
            self.assertEqual((block["command_result"], block["axis_state"], block["statusword"] & 0x6F), (2, STANDSTILL, 0x27))
            self.assertIn("enabled", axis.inputs())
            self.assertEqual(block["position_actual"], 0, "enable never moves")
            writes = self.sim.writes(drive)
            axis.command("enable")
            self.assertEqual(self.sim.writes(drive), writes, "already enabled: nothing is sent")

    def test_a_move_completes_at_its_target(self):
        for axis, drive in self.enabled():
            axis.set(target_position=3 * TURN)
            self.assertEqual(axis.get("motion_state"), NO_MOTION, "a set-point is no start")
            number = axis.command("move_absolute")
            block = axis.block()
            self.assertEqual((block["motion_state"], block["motion_id"], block["axis_state"]), (ACTIVE, number, DISCRETE))
            self.assertNotIn("target_reached", axis.inputs())
            block = self.arrive(axis, 3 * TURN)
            self.assertEqual((block["motion_id"], block["axis_state"]), (number, STANDSTILL))
            self.assertIn("target_reached", axis.inputs())
            self.assertAlmostEqual(self.sim.object(drive, "6063.00"), 3 * COUNTS_PER_TURN[axis.number], delta=100)

    def test_a_relative_move_adds_to_the_set_point(self):
        for axis, _ in self.enabled():
            for turns in (1, 2):
                axis.set(target_position=TURN)
                number = axis.command("move_relative")
                self.arrive(axis, turns * TURN, motion_id=number)

    def test_a_second_move_replaces_the_first_at_once(self):
        for axis, _ in self.enabled():
            axis.set(target_position=FAR)
            first = axis.command("move_absolute")
            self.until_moving(axis)
            axis.set(target_position=-TURN)
            self.assertEqual(axis.get("motion_id"), first, "a set-point is no start")
            second = axis.command("move_absolute")
            self.arrive(axis, -TURN, motion_id=second)

    def test_velocity_runs_changes_and_halts(self):
        for axis, drive in self.enabled():
            axis.set(target_velocity=100 * RPM)
            self.assertEqual(axis.get("axis_state"), STANDSTILL, "a set-point is no start")
            number = axis.command("run_velocity")
            self.assertEqual(axis.block()["axis_state"], CONTINUOUS)
            until("100 rpm", lambda: abs(axis.get("velocity_actual") - 100 * RPM) < 2 * RPM)
            axis.set(target_velocity=-200 * RPM)
            until("-200 rpm", lambda: abs(axis.get("velocity_actual") + 200 * RPM) < 2 * RPM)
            self.assertEqual((axis.get("motion_state"), axis.get("motion_id")), (ACTIVE, number))
            axis.command("halt")
            until("standstill", lambda: abs(axis.get("velocity_actual")) < RPM)
            block = axis.until(motion_state=ABORTED, axis_state=STANDSTILL)
            self.assertEqual(block["motion_id"], number)
            self.assertIn("operation", self.sim.state(drive), "halt keeps torque")
            axis.set(target_velocity=100 * RPM)
            self.assertEqual(axis.get("axis_state"), STANDSTILL, "nothing resumes")

    def test_a_halted_move_is_over(self):
        for axis, drive in self.enabled():
            axis.set(target_position=FAR)
            axis.command("move_absolute")
            self.until_moving(axis)
            axis.command("halt")
            axis.until(motion_state=ABORTED)
            axis.until_input("moving", False)
            where = axis.get("position_actual")
            axis.command("enable")
            self.assertAlmostEqual(axis.get("position_actual"), where, delta=50)
            self.assertNotIn("moving", axis.inputs())

    def test_quick_stop_latches_until_enabled_anew(self):
        for axis, drive in self.enabled():
            axis.set(target_position=FAR)
            axis.command("move_absolute")
            self.until_moving(axis)
            axis.command("quick_stop")
            block = axis.until(motion_state=ABORTED)
            self.assertTrue(block["axis_alarms"] & ALARM_STOP_LATCHED)
            self.assertLessEqual({"stop_latched", "quick_stop_active"}, axis.inputs())
            axis.until_input("moving", False)
            for refused in ("move_absolute", "move_relative", "run_velocity", "home"):
                with self.refused(REFUSED):
                    axis.command(refused)
                self.assertEqual((axis.get("command_result"), axis.get("command_detail")), (9, 0x08000022))
            target = self.sim.writes(drive, "607A.00")
            axis.set(target_position=2 * TURN)
            self.assertEqual(self.sim.writes(drive, "607A.00"), target, "kept, not sent")
            axis.command("enable")
            self.assertNotIn("stop_latched", axis.inputs())
            axis.set(target_position=TURN)
            axis.command("move_absolute")
            self.arrive(axis, TURN)

    def test_a_fault_is_shown_and_reset_but_never_enables(self):
        for axis, drive in self.enabled():
            axis.set(target_velocity=100 * RPM)
            axis.command("run_velocity")
            self.sim.ask(f"fault {drive} 2601 0x0020")
            block = axis.until(error_code=0x3210, axis_state=6)
            self.assertIn("fault", axis.inputs())
            self.assertEqual(block["vendor_error"], 0x0020)
            self.assertEqual(self.client.overview(axis.number)["error_code"], 0x3210)
            with self.refused(REFUSED):
                axis.command("enable")
            with self.refused(REFUSED, NO_ANSWER):  # its cause is still there
                axis.command("fault_reset")
            self.sim.ask(f"clear {drive} 2601 0x0020")
            axis.command("fault_reset")
            axis.until(error_code=0, axis_state=DISABLED)
            self.assertNotIn("operation", self.sim.state(drive))
            axis.command("enable")
            self.assertEqual(axis.get("velocity_actual"), 0, "a fault ends every motion for good")
            self.assertEqual(axis.get("axis_state"), STANDSTILL)

    def test_homing_method_35_makes_this_place_zero(self):
        for axis, drive in self.enabled():
            axis.set(target_position=TURN)
            axis.command("move_absolute")
            axis.until(motion_state=COMPLETED)
            with self.refused(BAD_VALUE):
                axis.command("home")  # no method was chosen
            axis.set(homing_method=35)
            number = axis.command("home")
            self.arrive(axis, 0, motion_id=number)
            self.assertIn("homed", axis.inputs())
            axis.set(target_position=TURN)
            axis.command("move_absolute")
            self.arrive(axis, TURN)

    def test_set_position_makes_this_place_zero(self):
        for axis, _ in self.enabled():
            axis.set(target_position=TURN)
            axis.command("move_absolute")
            self.arrive(axis, TURN)
            axis.until_input("moving", False)
            axis.set(set_position_value=0)
            axis.command("set_position")
            until("position 0", lambda: abs(axis.get("position_actual")) <= 20)
            self.assertEqual(axis.get("mode_display"), 1, "the mode it needed is put back")

    def test_disable_takes_the_torque_away_in_the_middle_of_a_move(self):
        for axis, drive in self.enabled():
            axis.set(target_position=FAR)
            axis.command("move_absolute")
            self.until_moving(axis)
            axis.command("disable")
            self.assert_without_torque(axis, drive)
            axis.until(motion_state=ABORTED, axis_state=DISABLED)
            with self.refused(REFUSED):
                axis.command("move_absolute")
            self.assertEqual(axis.get("command_result"), 9)

    def test_a_parameter_the_drive_holds_is_not_sent_again(self):
        for axis, drive in self.each():
            writes = self.sim.writes(drive)
            for _ in range(5):
                axis.set(profile_velocity=600 * RPM, profile_acceleration=30000, profile_deceleration=30000)
            self.assertEqual(self.sim.writes(drive), writes)

    def test_parameters_survive_a_save_and_a_restart(self):
        for axis, drive in self.each():
            axis.set(profile_acceleration=54321)
            stores = int(self.sim.ask(f"stores {drive}"))
            axis.command("save_parameters")
            until("stored", lambda: int(self.sim.ask(f"stores {drive}")) == stores + 1)
            axis.command("enable")
            with self.refused(BUSY):  # only without torque
                axis.command("save_parameters")
            self.sim.ask(f"restart {drive}")
            until("the restart is noticed", lambda: axis.get("link_state") != 2)
            axis.until(link_state=2)
            self.assertAlmostEqual(axis.get("profile_acceleration"), 54321, delta=10)
            self.assertNotIn("enabled", axis.inputs())


    def test_one_request_writes_reads_and_masks(self):
        for axis, drive in self.each():
            target = axis.first + AXIS["target_position"][0]
            reply = self.client.execute(ReadWriteMultipleRegistersRequest(
                read_address=target, read_count=2, write_address=target, write_registers=encode("i32", -4 * TURN), unit=1))
            self.assertEqual(reply.registers, encode("i32", -4 * TURN), "it reads what its write has done")
            self.assertEqual(self.sim.object(drive, "607A.00"), -4 * COUNTS_PER_TURN[axis.number])
            axis.set(homing_method=17)
            method = axis.first + AXIS["homing_method"][0]
            self.client.execute(MaskWriteRegisterRequest(method, and_mask=0x00F0, or_mask=0x0003, unit=1))
            self.assertEqual(axis.get("homing_method"), 0x13)
            self.assertEqual(self.sim.object(drive, "6098.00"), 0x13)


class ByCoils(Day):
    def test_a_button_panel_runs_the_axis(self):
        for axis, drive in self.each():
            axis.coil("enable")
            self.assertEqual(axis.coils(), {"enable"})
            axis.set(target_position=TURN)
            axis.coil("start_absolute")
            self.arrive(axis, TURN)
            axis.coil("start_absolute", False)
            axis.coil("start_relative")
            self.arrive(axis, 2 * TURN)
            axis.set(target_velocity=100 * RPM)
            with self.refused(BUSY):
                axis.coil("run_velocity")  # a 1 before any 0 may be a panel that reconnects
            axis.coil("run_velocity", False)
            axis.coil("run_velocity")
            self.assertIn("run_velocity", axis.coils())
            axis.coil("run_velocity", False)
            axis.until(axis_state=STANDSTILL)
            axis.set(target_velocity=100 * RPM)  # a stop has ended the one before for good
            axis.coil("run_velocity")
            until("100 rpm", lambda: abs(axis.get("velocity_actual") - 100 * RPM) < 2 * RPM)
            axis.coil("halt")
            axis.until(axis_state=STANDSTILL, motion_state=ABORTED)
            axis.coil("halt", False)
            self.assertNotIn("run_velocity", axis.coils())
            until("standstill", lambda: abs(axis.get("velocity_actual")) < RPM)
            axis.coil("quick_stop")
            self.assertIn("stop_latched", axis.inputs())
            with self.refused(BUSY):
                axis.coil("enable", True)  # the level that was held all the while: write 0 first
            axis.coil("enable", False)
            axis.coil("enable", True)
            self.assertNotIn("stop_latched", axis.inputs())
            axis.coil("enable", False)
            self.assert_without_torque(axis, drive)

    def test_a_reserved_coil_takes_0_only(self):
        self.client.ask(self.client.tcp.write_coil, 112, False)
        with self.refused(NO_ADDRESS):
            self.client.ask(self.client.tcp.write_coil, 112, True)


class ByControlword(Day):
    def test_6_7_15_enables_and_6_disables(self):
        for axis, drive in self.each():
            for word, status in ((6, 0x21), (7, 0x23), (15, 0x27)):
                axis.set(controlword=word)
                self.assertEqual(axis.get("statusword") & 0x6F, status)
                self.assertEqual(self.sim.object(drive, "6040.00"), word)
            self.assertEqual(axis.get("axis_state"), STANDSTILL)
            axis.set(controlword=6)
            self.assert_without_torque(axis, drive)

    def test_raw_start_of_a_move(self):
        for axis, _ in self.each():
            for word in (6, 7, 15):
                axis.set(controlword=word)
            axis.set(mode=1, target_position=TURN)
            axis.set(controlword=0x2F)
            axis.set(controlword=0x3F)
            self.arrive(axis, TURN)

    def test_quick_stop_bit_latches(self):
        for axis, drive in self.each():
            for word in (6, 7, 15):
                axis.set(controlword=word)
            axis.set(controlword=0x0B)
            self.assertIn("stop_latched", axis.inputs())
            self.assert_without_torque(axis, drive)
            for word in (6, 7, 15):
                axis.set(controlword=word)
            self.assertNotIn("stop_latched", axis.inputs())
            self.assertIn("enabled", axis.inputs())


class ByScanner(Day):
    """An I/O scanner writes offsets 40 to 56 as one block, again and again; its writes are posted."""

    def setUp(self):
        Story.setUp(self)
        self.start([self.listener(writes="posted")])

    def scan(self, axis, target, command, number):
        rows = (("controlword", 0), ("mode", 1), ("target_position", target), ("target_velocity", 0), ("target_torque", 0),
                ("max_torque", 0), ("profile_velocity", 600 * RPM), ("profile_acceleration", 30000), ("profile_deceleration", 30000),
                ("command", command), ("command_id", number))
        words = [word for name, value in rows if name not in ("target_torque", "max_torque") for word in encode(AXIS[name][1], value)]
        # No torque without a rated current: these two offsets hold what is not supported and are left out.
        for offset, part in ((40, words[:6]), (48, words[6:])):
            try:
                self.client.write(axis.first + offset, *part)
            except Refused as refused:  # faster than the bus: the next scan brings it again
                self.assertEqual(refused.code, BUSY)
        return axis.block()

    def test_the_outcome_stands_in_the_block(self):
        for number, drive in BOTH.items():
            axis = self.axis(number)
            first = 100
            until("the id is seen", lambda: self.scan(axis, 0, 0, first) and axis.get("command_id_seen") == first)
            for step, (command, target) in enumerate(((1, 0), (6, TURN), (6, 2 * TURN), (2, 2 * TURN)), 1):
                wanted = first + step
                until(f"command {command} is done", lambda: self.scan(axis, target, command, wanted)["command_result"] == 2
                      and axis.get("command_id_seen") == wanted)
                if command == 6:
                    until("arrived", lambda: self.scan(axis, target, command, wanted)["motion_state"] == COMPLETED)
                    self.assertEqual(axis.get("motion_id"), wanted)
            self.assert_without_torque(axis, drive)
            writes = self.sim.writes(drive)
            for _ in range(20):
                self.scan(axis, 2 * TURN, 2, first + 4)
            self.assertEqual(self.sim.writes(drive), writes, "what the drive holds is not sent again")


class ByMbpoll(Day):
    """Each call is a connection of its own; the second listener takes all of them for one client."""

    def call(self, table, offset, *values, **more):
        return mbpoll(self.ports[1], table, offset, *values, **more)

    def test_one_shot_calls_run_the_axis(self):
        for axis, drive in self.each():
            first = axis.first
            self.call("0", first, 1)
            self.assertIn("operation", self.sim.state(drive))
            self.call("4:int", first + 42, -2 * TURN)
            self.call("0", first + 4, 1)
            self.arrive(axis, -2 * TURN)
            self.assertAlmostEqual(self.call("4:int", first + 2)[0], -2 * TURN, delta=20)
            self.call("4", first + 54, 2)
            self.assert_without_torque(axis, drive)
            self.assertEqual(self.call("4", first + 25), [2], "the result belongs to all calls of this host")

    def test_refusals_have_the_words_of_the_tool(self):
        for words, arguments in (("Illegal data address", ("4", 102, 1)), ("Illegal data address", ("4", 142, 1)),
                                 ("Illegal data value", ("4", 154, 99)), ("Slave device or server failure", ("4", 154, 6))):
            with self.assertRaises(MbpollFailed) as caught:
                self.call(*arguments)
            self.assertIn(words, str(caught.exception))


if __name__ == "__main__":
    main()
