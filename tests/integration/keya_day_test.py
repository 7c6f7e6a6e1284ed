# SPDX-License-Identifier: Apache-2.0
"""A day with a Keya on each of its interfaces: both motors come online, obey one by one, and are read back."""
from keya_stage import (ALARM_NO_COMM_WATCHDOG, CANOPEN, KEYA_CAN, LONGER_THAN_A_WATCHDOG, RPM, RS232, RS485, SPEED, TURN,
                        KeyaStory, main, on)
from modbus import (ABORTED, ALARM_ADOPTED, ALARM_STOP_LATCHED, COMMANDS, COMPLETED, CONTINUOUS, DISABLED, NO_ADDRESS, NO_MOTION, ONLINE,
                    REFUSED, STANDSTILL)
from processes import until


class TwoMotorsAtSpeed(KeyaStory):
    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_they_obey_one_by_one(self, interface):
        self.begin(interface)
        self.look_at_first()
        left, right = self.axes
        self.enable(left)
        self.assertEqual(self.enabled(), [True, False], "each by itself")
        self.run_axis(left)
        self.assertEqual(right.get("axis_state"), DISABLED)
        self.enable(right)
        self.assertEqual(self.enabled(), [True, True])
        self.run_axis(right, -2 * SPEED)
        self.read_back()
        self.stop_one_by_one()
        self.assertEqual(self.trips(), 0)

    def look_at_first(self):
        for axis in self.seen:
            block = axis.block()
            self.assertEqual((block["link_state"], block["axis_state"], block["motion_state"]), (ONLINE, DISABLED, NO_MOTION))
            self.assertEqual((block["error_code"], block["vendor_error"], block["dc_voltage"]), (0, 0, 480))
            self.assertEqual(block["statusword"] & 0x6F, 0x40, "disabled, and its fault bit 0 is no fault")
            self.assertEqual(axis.inputs() & {"online", "ready", "enabled", "fault", "moving"}, {"online", "ready"})
            watchdog = 0 if self.interface.loss else ALARM_NO_COMM_WATCHDOG
            self.assertEqual(block["axis_alarms"] & (ALARM_NO_COMM_WATCHDOG | ALARM_ADOPTED), watchdog)
            for name in ("run_torque", "home", "save_parameters"):
                self.assertFalse(block["supported_commands"] >> COMMANDS[name] & 1, name)
                with self.refused(NO_ADDRESS):
                    self.client.axis(axis.number).command(name)
        self.assertEqual((self.commands(), self.enabled()), (0, [False, False]), "nobody asked for anything")

    def read_back(self):
        left, right = self.seen
        until("the drive is at speed", lambda: self.speeds() == [SPEED, -2 * SPEED])
        left.until(velocity_actual=SPEED * RPM, axis_state=CONTINUOUS)
        right.until(velocity_actual=-2 * SPEED * RPM, axis_state=CONTINUOUS)
        self.assertEqual(left.inputs() & {"enabled", "moving", "fault"}, {"enabled", "moving"})
        before = [axis.get("position_actual") for axis in self.seen]
        until("both have turned", lambda: left.get("position_actual") > before[0] + TURN
              and right.get("position_actual") < before[1] - TURN)

    def stop_one_by_one(self):
        left, right = self.axes
        left.command("halt")
        block = left.until(axis_state=STANDSTILL, motion_state=ABORTED)
        until("left stands", lambda: self.speeds()[0] == 0)
        self.assertEqual(block["axis_alarms"] & ALARM_STOP_LATCHED, 0)
        self.assertEqual((self.enabled(), self.speeds()[1]), ([True, True], -2 * SPEED), "the other goes on")
        left.until(position_actual=self.positions()[0])
        self.run_axis(left, 2 * SPEED)
        right.command("quick_stop")
        until("right stands without torque", lambda: self.speeds()[1] == 0 and self.enabled() == [True, False])
        self.assertIn("stop_latched", right.inputs())
        self.assertEqual(self.speeds()[0], 2 * SPEED, "the other goes on")
        with self.refused(REFUSED):
            right.command("run_velocity")
        self.assertEqual(self.enabled(), [True, False])
        left.command("disable")
        self.until_it_stands()
        self.enable(right)
        self.assertEqual((self.enabled(), self.speeds()), ([False, True], [0, 0]), "what it ran before is forgotten")
        self.run_axis(right)
        right.command("disable")
        self.until_it_stands()


class OneMotorInPositionMode(KeyaStory):
    """Motor A positions, motor B runs at speed: parameters 0020 and 0050."""

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_what_is_sent_again_moves_nothing(self, interface):
        self.begin(interface, drive="+0020=3", constants={"control_mode_a": 3})
        left, right = self.axes
        self.sim.ask("set cart/1 count A 25000")
        left.until(position_actual=25000)
        self.enable(left)
        self.enable(right)
        self.run_axis(right)
        self.assertEqual(self.positions()[0], 25000, "an enable moves nothing")
        self.move(left, 5 * TURN)
        self.move(left, -2 * TURN)
        commands = self.commands()
        self.let_pass(LONGER_THAN_A_WATCHDOG)
        if interface.loss:
            self.assertGreater(self.commands(), commands, "it is kept alive")
        self.assertEqual((self.positions()[0], self.trips()), (-2 * TURN, 0), "what is sent again moves nothing")
        left.command("disable")
        until("motor A is disabled", lambda: self.enabled() == [False, True])
        right.command("quick_stop")
        self.until_it_stands()
        self.assertEqual(self.positions()[0], -2 * TURN)

    def move(self, axis, target):
        axis.set(target_position=target)
        number = axis.command("move_absolute")
        axis.until(motion_state=COMPLETED, motion_id=number)
        self.assertAlmostEqual(self.positions()[0], target, delta=10)


class ModeChosenByTheClient(KeyaStory):
    """On CANopen the code that enables a motor can choose its mode."""

    def setUp(self):
        super().setUp()
        self.begin(CANOPEN)
        self.left = self.axes[0]
        self.enable(self.left)
        self.run_axis(self.left)
        until("more than two turns", lambda: self.positions()[0] > 2 * TURN)

    def disable(self):
        self.left.command("disable")
        self.left.until(axis_state=DISABLED)
        self.until_it_stands()

    def test_a_speed_is_not_shown_as_a_position(self):
        target_position = 1 << 16
        self.assertFalse(self.left.get("valid") & target_position, f"target_position reads {self.left.get('target_position')}")
        self.disable()
        self.assertFalse(self.left.get("valid") & target_position, f"target_position reads {self.left.get('target_position')}")


if __name__ == "__main__":
    main()
