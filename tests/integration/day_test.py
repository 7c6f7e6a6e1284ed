# SPDX-License-Identifier: Apache-2.0
"""The operator's day on a drive of each type and protocol: by commands, by coils, by raw controlwords, and by mbpoll. What each drive
does in every situation is told by tests/obey and tests/unit/drive."""
from lease_stage import COILS, COMMANDS, RPM, Machine, main
from modbus import (ABORTED, ACTIVE, ALARM_CANNOT_DEENERGISE, ALARM_STOP_LATCHED, BUSY, COMPLETED, CONTINUOUS, DISABLED, DISCRETE,
                    ERROR_STOP, NO_MOTION, REFUSED, STANDSTILL, Axis, MbpollFailed, mbpoll)
from processes import until

TURN = 10000
FAR = 2000 * TURN
COUNTS_PER_TURN = {"modbus": 65536}  # of the others: 10000
# Line: the simulator's word for a fault, what error_code and vendor_error show of it.
FAULTS = {"stepper": ("14", 0x3210, 14), "leadshine": ("0x2211", 0x2211, None), "keya232": ("MOTOR 0x0040", 0x2310, 0x0040),
          "keyacan": ("MOTOR 0x0040", 0x2310, 0x0040)}
FAULT_OF_A_KINCO = ("2601 0x0020", 0x3210, 0x0020)


class Day(Machine):
    lease = None

    def setUp(self):
        super().setUp()
        self.begin()
        self.operator = self.peer()

    def axes(self, *commands):
        """Those that know these commands, with ramps. Of the two motors of a Keya the first: they are alike."""
        for number in self.each():
            if self.motors[number][1] == "B":
                continue
            axis = Axis(self.operator, number)
            if all(axis.get("supported_commands") >> COMMANDS[name] & 1 for name in commands):
                self.prepare(axis)
                yield axis

    def line(self, axis):
        return self.motors[axis.number][0]

    def arrive(self, axis, target, **more):
        """The motion completes, and where the drive says so."""
        axis.until(motion_state=COMPLETED, **more)
        until(f"position {target}", lambda: abs(axis.get("position_actual") - target) <= 20)
        counts = target * COUNTS_PER_TURN.get(self.line(axis), 10000) // TURN
        self.assertAlmostEqual(int(self.sim.ask(f"position {self.line(axis)}/1")), counts, delta=150)

    def assert_without_torque(self, axis):
        self.until_it_stands(axis.number)
        self.until_without_torque(axis.number)
        if self.line(axis) == "stepper":
            self.assertTrue(axis.get("axis_alarms") & ALARM_CANNOT_DEENERGISE, "it holds torque, whatever the bus says")
        else:
            axis.until_input("enabled", False)


class ByCommands(Day):
    def test_moves_arrive_are_replaced_and_end_with_each_stop(self):
        for axis in self.axes("move_absolute"):
            self.enable(axis)
            self.assertEqual(axis.get("position_actual"), 0, "enable never moves")
            axis.set(profile_velocity=600 * RPM, target_position=FAR)
            self.assertEqual(axis.get("motion_state"), NO_MOTION, "a set-point is no start")
            number = axis.command("move_absolute")
            axis.until(motion_state=ACTIVE, motion_id=number, axis_state=DISCRETE)
            axis.until_input("moving")
            axis.set(target_position=3 * TURN)
            self.arrive(axis, 3 * TURN, motion_id=axis.command("move_absolute"))
            self.assertIn("target_reached", axis.inputs())
            axis.set(target_position=-TURN)
            self.arrive(axis, 2 * TURN, motion_id=axis.command("move_relative"))
            for stop in ("halt", "quick_stop", "disable"):
                axis.set(target_position=FAR)
                number = axis.command("move_absolute")
                axis.until_input("moving")
                axis.command(stop)
                block = axis.until(motion_state=ABORTED, motion_id=number)
                if stop == "quick_stop":
                    self.assertTrue(block["axis_alarms"] & ALARM_STOP_LATCHED)
                self.until_it_stands(axis.number)
                if stop != "halt":
                    with self.refused(REFUSED):
                        axis.command("move_absolute")
                self.enable(axis)
                axis.set(target_position=TURN)
                self.arrive(axis, TURN, motion_id=axis.command("move_absolute"))
            axis.command("disable")
            self.assert_without_torque(axis)

    def test_runs_follow_their_velocity_and_end_with_each_stop(self):
        for axis in self.axes("run_velocity"):
            self.enable(axis)
            axis.set(target_velocity=100 * RPM)
            self.assertEqual(axis.get("axis_state"), STANDSTILL, "a set-point is no start")
            for stop in ("halt", "quick_stop", "disable"):
                axis.set(target_velocity=100 * RPM)
                number = axis.command("run_velocity")
                axis.until(axis_state=CONTINUOUS, motion_state=ACTIVE, motion_id=number)
                self.until_it_turns_at(axis.number, 100)
                axis.set(target_velocity=-200 * RPM)
                self.until_it_turns_at(axis.number, -200)
                self.assertEqual(axis.get("motion_id"), number)
                axis.command(stop)
                self.until_it_stands(axis.number)
                axis.until(motion_state=ABORTED, motion_id=number)
                if stop != "halt":
                    with self.refused(REFUSED):
                        axis.command("run_velocity")
                self.enable(axis)
                self.assertEqual(self.speed(axis.number), 0, "nothing resumes")
            axis.command("disable")
            self.assert_without_torque(axis)

    def test_homing_makes_this_place_zero(self):
        for axis in self.axes("home", "move_absolute"):
            if self.line(axis) == "stepper":  # it homes on a switch alone
                continue
            self.enable(axis)
            axis.set(profile_velocity=600 * RPM, target_position=TURN)
            self.arrive(axis, TURN, motion_id=axis.command("move_absolute"))
            axis.set(homing_method=35)
            number = axis.command("home")
            axis.until(motion_state=COMPLETED, motion_id=number)
            until("position 0", lambda axis=axis: abs(axis.get("position_actual")) <= 20)
            self.assertIn("homed", axis.inputs())

    def test_a_fault_is_shown_and_reset_but_never_enables(self):
        for axis in self.axes("run_velocity"):
            line, motor = self.motors[axis.number]
            cause, code, vendors = FAULTS.get(line, FAULT_OF_A_KINCO)
            cause = cause.replace("MOTOR", motor or "")
            self.set_running(axis, 100)
            self.sim.ask(f"fault {line}/1 {cause}")
            axis.until(error_code=code, axis_state=ERROR_STOP, **({"vendor_error": vendors} if vendors else {}))
            self.assertIn("fault", axis.inputs())
            self.assertEqual(self.operator.overview(axis.number)["error_code"], code)
            with self.refused(REFUSED):
                axis.command("enable")
            self.sim.ask(f"clear {line}/1 {cause}")
            axis.command("fault_reset")
            axis.until(error_code=0, axis_state=DISABLED)
            self.until_it_stands(axis.number)
            self.enable(axis)
            self.assertEqual(self.speed(axis.number), 0, "a fault ends every motion for good")
            axis.until(axis_state=STANDSTILL)
            axis.command("disable")


class ByCoils(Day):
    def test_a_button_panel_runs_the_axis(self):
        for axis in self.axes("run_velocity"):
            axis.coil("enable")
            self.assertEqual(axis.coils(), {"enable"})
            axis.set(target_velocity=100 * RPM)
            with self.refused(BUSY):
                axis.coil("run_velocity")  # a 1 before any 0 may be a panel that reconnects
            axis.coil("run_velocity", False)
            axis.coil("run_velocity")
            self.assertIn("run_velocity", axis.coils())
            self.until_it_turns_at(axis.number, 100)
            axis.coil("halt")
            axis.until(axis_state=STANDSTILL, motion_state=ABORTED)
            axis.coil("halt", False)
            self.assertNotIn("run_velocity", axis.coils())
            axis.coil("quick_stop")
            self.assertIn("stop_latched", axis.inputs())
            with self.refused(BUSY):
                axis.coil("enable")  # the level that was held all the while: write 0 first
            axis.coil("enable", False)
            axis.coil("enable")
            self.assertNotIn("stop_latched", axis.inputs())
            axis.coil("enable", False)
            self.assert_without_torque(axis)


class ByControlword(Day):
    def test_6_7_15_enables_6_disables_and_a_quick_stop_latches(self):
        for axis in self.axes():
            for stop in (6, 0x0B):
                for word, status in ((6, 0x21), (7, 0x23), (15, 0x27)):
                    axis.set(controlword=word)
                    self.assertEqual(axis.get("statusword") & 0x6F, status)
                axis.until(axis_state=STANDSTILL)
                self.assertEqual(axis.inputs() & {"enabled", "stop_latched"}, {"enabled"})
                axis.set(controlword=stop)
                self.assertEqual("stop_latched" in axis.inputs(), stop == 0x0B)
                self.assert_without_torque(axis)

    def test_raw_start_of_a_move(self):
        for axis in self.axes("move_absolute"):
            for word in (6, 7, 15):
                axis.set(controlword=word)
            axis.set(mode=1, profile_velocity=600 * RPM, target_position=TURN)
            axis.set(controlword=0x2F)
            axis.set(controlword=0x3F)
            self.arrive(axis, TURN)


class ByMbpoll(Day):
    """Each call is a connection of its own; the listener takes all of one host for one client."""

    listener_options = {"client": "address"}

    def test_one_shot_calls_run_the_axis(self):
        for axis in self.axes("move_absolute"):
            first = axis.first
            axis.set(profile_velocity=600 * RPM)
            for table, offset, value in (("0", COILS.index("enable"), 1), ("4:int", 42, -2 * TURN), ("0", COILS.index("start_absolute"), 1)):
                mbpoll(self.ports[0], table, first + offset, value)
            self.arrive(axis, -2 * TURN)
            self.assertAlmostEqual(mbpoll(self.ports[0], "4:int", first + 2)[0], -2 * TURN, delta=20)
            mbpoll(self.ports[0], "4", first + 54, COMMANDS["disable"])
            self.assert_without_torque(axis)
            self.assertEqual(mbpoll(self.ports[0], "4", first + 25), [2], "the result belongs to all calls of this host")

    def test_refusals_have_the_words_of_the_tool(self):
        for words, arguments in (("Illegal data address", ("4", 102, 1)), ("Illegal data address", ("4", 142, 1)),
                                 ("Illegal data value", ("4", 154, 99)), ("Slave device or server failure", ("4", 154, 6))):
            with self.assertRaises(MbpollFailed) as caught:
                mbpoll(self.ports[0], *arguments)
            self.assertIn(words, str(caught.exception))


if __name__ == "__main__":
    main()
