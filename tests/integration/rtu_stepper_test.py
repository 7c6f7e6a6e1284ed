# SPDX-License-Identifier: Apache-2.0
"""A PLC's day with an iD286pro on Modbus RTU: a stepper that is no CiA 402 drive, and reads and obeys like a servo all the same."""
from modbus import (ABORTED, ACTIVE, ALARM_CANNOT_DEENERGISE, ALARM_STOP_LATCHED, AXIS, BAD_VALUE, COMPLETED, CONTINUOUS, DISABLED,
                    DISCRETE, ERROR_STOP, FAILED, NO_MOTION, REFUSED, STANDSTILL, mbpoll)
from processes import until
from stage import Story, bus, drive, main

TURN = 10000  # pulses of the drive too: its microstep setting as delivered
FAR = 2000 * TURN
RPM = 1000
STEPPER = "line/1"
COMMAND_REGISTER = 323


class Stepper(Story):
    sim_options = ("--boot-ms", "5000")  # a restart is silent for longer than the gateway waits
    lines = {"line": "rtu:id286pro@1"}

    def buses(self):
        return [bus(self.path("line"), drive("id286pro", 1, 1), adapter="modbus-rtu")]

    def setUp(self):
        super().setUp()
        self.begin()

    def begin(self, **options):
        self.start(**options)
        self.stepper = self.axis(1)
        self.stepper.set(profile_velocity=600 * RPM, profile_acceleration=300000, profile_deceleration=300000)

    def enable(self):
        self.stepper.command("enable")
        self.stepper.until(axis_state=STANDSTILL)

    def move(self, turns):
        self.stepper.set(target_position=turns * TURN)
        number = self.stepper.command("move_absolute")
        return self.stepper.until(motion_state=COMPLETED, motion_id=number)

    def run_at(self, rpm):
        self.stepper.set(target_velocity=rpm * RPM)
        number = self.stepper.command("run_velocity")
        self.until_velocity(rpm)
        return number

    def until_velocity(self, rpm):
        until(f"{rpm} rpm", lambda: abs(self.stepper.get("velocity_actual") - rpm * RPM) < RPM)

    def commands(self):
        """How often the bus wrote the command register."""
        return int(self.sim.ask(f"writes {STEPPER} {COMMAND_REGISTER}"))

    def until_it_stands(self):
        until("the drive stands", lambda: self.sim.state(STEPPER).startswith("stopped"))


class FirstContact(Stepper):
    def test_it_reads_as_a_servo_that_is_disabled(self):
        block = self.stepper.block()
        self.assertEqual((block["link_state"], block["axis_state"], block["motion_state"]), (2, DISABLED, NO_MOTION))
        self.assertEqual(block["statusword"] & 0x6F, 0x40)
        self.assertEqual((block["error_code"], block["position_actual"], block["velocity_actual"]), (0, 0, 0))
        self.assertEqual(block["valid"] & block["supported"], block["supported"])
        self.assertEqual(block["dc_voltage"], 480)
        self.assertEqual(self.stepper.inputs() & {"online", "ready", "enabled", "fault", "moving"}, {"online", "ready"})
        self.assertTrue(block["axis_alarms"] & ALARM_CANNOT_DEENERGISE, "it holds torque, whatever the bus says")
        self.assertTrue(self.sim.state(STEPPER).startswith("stopped"))
        self.assertEqual(self.commands(), 0, "nobody asked for anything")

    def test_what_it_has_not_is_told_and_refused(self):
        block = self.stepper.block()
        for name, bit in (("torque_actual", 4), ("current_actual", 5), ("drive_temperature", 11)):
            self.assertFalse(block["supported"] >> bit & 1, name)
        for name in ("target_torque", "homing_offset"):
            with self.refused(0x02):
                self.stepper.set(**{name: 1})

    def test_two_clients_that_nobody_here_wrote_read_the_same(self):
        self.stepper.set(target_position=-123456)
        self.assertEqual(mbpoll(self.ports[0], "4:int", 142), [-123456])
        self.assertEqual(mbpoll(self.ports[0], "1", 100, count=3), [1, 1, 0])
        self.assertEqual(len(mbpoll(self.ports[0], "4", 100, count=39)), 39)
        self.assertEqual(int(self.sim.ask(f"get {STEPPER} 313").split()[0]), -123456)

    def test_map_prints_its_block_like_any_other(self):
        done = self.command_line("map", self.config, "--format", "csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        for name, (offset, _) in AXIS.items():
            self.assertRegex(done.stdout, rf"(?m)^holding,{100 + offset},.*,{name},")


class Motion(Stepper):
    def setUp(self):
        super().setUp()
        self.enable()

    def test_enable_moves_nothing_and_opens_the_gate(self):
        self.assertEqual(self.stepper.get("statusword") & 0x6F, 0x27)
        self.assertIn("enabled", self.stepper.inputs())
        self.assertFalse(self.stepper.get("axis_alarms") & ALARM_CANNOT_DEENERGISE)
        self.assertEqual((self.stepper.get("position_actual"), self.commands()), (0, 0))

    def test_a_move_completes_at_its_target(self):
        self.stepper.set(target_position=3 * TURN)
        self.assertEqual(self.stepper.get("motion_state"), NO_MOTION, "a set-point is no start")
        number = self.stepper.command("move_absolute")
        block = self.stepper.block()
        self.assertEqual((block["motion_state"], block["motion_id"], block["axis_state"]), (ACTIVE, number, DISCRETE))
        self.assertNotIn("target_reached", self.stepper.inputs())
        block = self.stepper.until(motion_state=COMPLETED, axis_state=STANDSTILL)
        self.assertEqual((block["motion_id"], block["position_actual"]), (number, 3 * TURN))
        self.assertIn("target_reached", self.stepper.inputs())
        self.assertEqual(int(self.sim.ask(f"position {STEPPER}")), 3 * TURN)

    def test_velocity_changes_while_it_runs_and_halts(self):
        number = self.run_at(120)
        self.assertEqual(self.stepper.get("axis_state"), CONTINUOUS)
        self.stepper.set(target_velocity=-60 * RPM)
        self.until_velocity(-60)
        self.assertEqual((self.stepper.get("motion_state"), self.stepper.get("motion_id")), (ACTIVE, number))
        self.stepper.command("halt")
        self.assertEqual(self.stepper.until(motion_state=ABORTED, axis_state=STANDSTILL)["motion_id"], number)
        self.until_velocity(0)
        self.assertIn("enabled", self.stepper.inputs(), "a halt leaves the gate open")
        started = self.commands()
        self.stepper.set(target_velocity=120 * RPM)
        self.assertEqual((self.commands(), self.stepper.get("axis_state")), (started, STANDSTILL), "nothing resumes")

    def test_quick_stop_latches_until_enabled_anew(self):
        self.stepper.set(target_position=FAR)
        self.stepper.command("move_absolute")
        self.stepper.until_input("moving")
        self.stepper.command("quick_stop")
        block = self.stepper.until(motion_state=ABORTED)
        self.assertTrue(block["axis_alarms"] & ALARM_STOP_LATCHED)
        self.until_it_stands()
        started = self.commands()
        for name in ("move_absolute", "move_relative", "run_velocity", "home"):
            with self.refused(REFUSED):
                self.stepper.command(name)
        self.assertEqual(self.commands(), started)
        self.enable()
        self.assertEqual(self.commands(), started, "enabling starts nothing")
        self.assertNotIn("stop_latched", self.stepper.inputs())
        self.move(1)

    def test_disable_stops_and_says_that_the_torque_stays(self):
        self.stepper.set(target_position=FAR)
        self.stepper.command("move_absolute")
        self.stepper.until_input("moving")
        self.stepper.command("disable")
        block = self.stepper.until(axis_state=DISABLED, motion_state=ABORTED)
        self.assertEqual(block["statusword"] & 0x6F, 0x23)
        self.assertTrue(block["axis_alarms"] & ALARM_CANNOT_DEENERGISE)
        self.until_it_stands()
        with self.refused(REFUSED):
            self.stepper.command("move_absolute")

    def test_the_raw_controlword_of_a_servo_works(self):
        for word in (6, 7, 15):
            self.stepper.set(controlword=word)
        self.assertEqual(self.stepper.get("statusword") & 0x6F, 0x27)
        self.stepper.set(mode=1, target_position=TURN)
        self.stepper.set(controlword=0x0F)
        self.stepper.set(controlword=0x1F)
        self.stepper.until(motion_state=COMPLETED, position_actual=TURN)

    def test_a_button_panel_runs_it(self):
        self.stepper.set(target_position=TURN)
        self.stepper.coil("start_absolute")
        self.stepper.until(motion_state=COMPLETED, position_actual=TURN)
        self.stepper.set(target_velocity=60 * RPM)
        self.stepper.coil("run_velocity", False)
        self.stepper.coil("run_velocity")
        self.until_velocity(60)
        self.stepper.coil("run_velocity", False)
        self.stepper.until(axis_state=STANDSTILL)
        self.stepper.coil("enable", False)
        self.stepper.until(axis_state=DISABLED)


class Faults(Stepper):
    def test_a_fault_is_shown_and_reset_but_never_enables(self):
        self.enable()
        number = self.run_at(120)
        self.sim.ask(f"fault {STEPPER} 14")
        block = self.stepper.until(error_code=0x3210, axis_state=ERROR_STOP)
        self.assertEqual((block["vendor_error"], block["motion_id"]), (14, number))
        self.assertIn("fault", self.stepper.inputs())
        with self.refused(REFUSED):
            self.stepper.command("enable")
        self.sim.ask(f"clear {STEPPER} 14")
        self.stepper.command("fault_reset")
        self.stepper.until(error_code=0, axis_state=DISABLED, motion_state=FAILED)
        self.enable()
        self.assertEqual(self.stepper.get("velocity_actual"), 0, "a fault ends every motion for good")

    def test_a_drive_that_follows_pulses_says_so(self):
        self.sim.ask(f"set {STEPPER} 296 0")
        self.sim.ask(f"restart {STEPPER}")
        until("the restart is noticed", lambda: self.stepper.get("link_state") != 2)
        self.stepper.until(link_state=2)
        self.gateway.wait_for("0296 is 0")


class Homing(Stepper):
    lines = {"line": "rtu:id286pro@1+400=10+limits=-30000..900000"}

    def test_it_homes_on_its_limit_and_a_method_of_others_is_refused(self):
        self.enable()
        with self.refused(BAD_VALUE):
            self.stepper.command("home")
        with self.refused(BAD_VALUE):
            self.stepper.set(homing_method=35)
        self.stepper.set(homing_method=17)
        number = self.stepper.command("home")
        self.stepper.until(motion_state=COMPLETED, motion_id=number, position_actual=0)
        self.assertIn("homed", self.stepper.inputs())
        self.move(1)

    def test_set_position_takes_any_value(self):
        self.enable()
        for value in (123456, -70000, 0):
            self.stepper.set(set_position_value=value)
            self.stepper.command("set_position")
            self.assertEqual(self.stepper.get("position_actual"), value)
            self.assertEqual(int(self.sim.ask(f"position {STEPPER}")), value)
        self.assertEqual(self.stepper.get("velocity_actual"), 0)


class Objects(Stepper):
    def ask(self, request, register, size, data=0):
        self.stepper.set(object_index=register, object_subindex=0, object_size=size, object_data=data)
        self.stepper.set(object_request=request)
        return until("the mailbox is done", lambda: (block := self.stepper.block()) if self.stepper.get("object_status") >= 2 else None)

    def test_any_register_is_read_and_written(self):
        self.assertEqual(self.ask(1, 110, 2)["object_status"], 2)
        self.assertEqual(self.ask(1, 242, 4)["object_data"], 10000)
        self.assertEqual(self.ask(2, 245, 2, 700)["object_status"], 2)
        self.assertEqual(self.ask(1, 245, 2)["object_data"], 700)
        self.assertEqual(self.ask(2, 311, 4, 0x12345678)["object_status"], 2)
        self.assertEqual(int(self.sim.ask(f"get {STEPPER} 311").split()[0]), 0x12345678)
        self.assertEqual(self.ask(1, 311, 4)["object_data"], 0x12345678)

    def test_what_the_drive_refuses_comes_with_its_exception(self):
        for register in (150, 9999):
            block = self.ask(1, register, 2)
            self.assertEqual((block["object_status"], block["object_detail"]), (3, 2))
            self.assertEqual(block["link_state"], 2)


if __name__ == "__main__":
    main()
