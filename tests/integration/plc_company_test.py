# SPDX-License-Identifier: Apache-2.0
"""A PLC is not alone: a second PLC, and a panel with buttons, on the same axes."""
from lease_stage import PANEL_1
from modbus import Axis, Refused
from plc_stage import PLC, TURN, PlcStory, main

SPEED = 5.0 * TURN
SECOND = "127.0.0.2"
NOT_OWNER = 7
RANKS = [{"from": PLC, "role": "operator", "rank": 3}, {"from": SECOND, "role": "operator", "rank": 5},
         {"from": "127.0.0.0/8", "role": "engineer"}]


class Company(PlcStory):
    lines_of = ("serial", "leadshine")
    allow = RANKS

    def setUp(self):
        super().setUp()
        self.begin()
        self.first = self.plc()

    def run_first(self):
        self.first.enable()
        for number in self.numbers:
            self.first.begin(number, "MoveVelocity", Velocity=SPEED)
        for number in self.numbers:
            self.first.until_at_speed(number)

    def assert_fails(self, plc, number, block, error, **inputs):
        made = plc.begin(number, block, **inputs)
        self.until("its end", lambda: not made.Busy)
        self.assertEqual((made.Error, made.ErrorID), (True, error))
        plc.end(number, block)


class TwoPlcs(Company):
    def setUp(self):
        super().setUp()
        self.second = self.plc(address=SECOND, cycle_ms=30)

    def test_the_second_moves_nothing_of_the_firsts_and_may_stop_it(self):
        self.run_first()
        for number in self.numbers:
            self.second[number].Power.Enable = True
            self.until("it is refused", lambda number=number: self.second[number].Power.Error)
            self.assertEqual(self.second[number].Power.ErrorID, NOT_OWNER)
            self.assert_fails(self.second, number, "MoveVelocity", NOT_OWNER, Velocity=-SPEED)
            self.assert_fails(self.second, number, "MoveAbsolute", NOT_OWNER, Position=0.0)
            self.assertTrue(self.first[number].MoveVelocity.InVelocity, "it runs on")
            self.second.do(number, "Stop")
            self.until_motor_stands(number)
            self.until("the first is told", lambda number=number: not self.first[number].MoveVelocity.Busy)
            self.assertEqual(self.first.end(number, "MoveVelocity"), "CommandAborted")
        self.run_first()

    def test_who_has_the_higher_rank_takes_over(self):
        self.run_first()
        for number in self.numbers:
            self.second.do(number, "TakeOver")
            self.until_motor_stands(number)
            self.until("the first is told", lambda number=number: not self.first[number].MoveVelocity.Busy)
            self.assertEqual(self.first.end(number, "MoveVelocity"), "CommandAborted")
            self.assertEqual(self.second[number].Axis.Owner, 1)
            self.until_told(number, "has taken the axis over from a lower rank")
            self.assert_fails(self.first, number, "MoveVelocity", NOT_OWNER, Velocity=SPEED)
            self.second[number].Power.Enable = True
            self.until("the second has it", lambda number=number: self.second[number].Power.Status)
            self.second.begin(number, "MoveVelocity", Velocity=-SPEED)
            self.second.until_at_speed(number)
            self.assert_fails(self.first, number, "TakeOver", NOT_OWNER)


class PlcAndPanel(Company):
    """The panel has its own address; its buttons are coils."""

    def setUp(self):
        super().setUp()
        self.panel = {number: Axis(self.peer(PANEL_1), number) for number in self.numbers}

    allow = [{"from": PLC, "role": "operator", "rank": 3}, {"from": "127.0.0.0/8", "role": "engineer"}]

    def press(self, number, coil, on=True):
        """In a thread of its own: the PLC goes on meanwhile. The exception's code, or 0."""
        pressed = self.later(self.panel[number].coil, coil, on)
        self.until("the button is answered", pressed.done)
        return self.code_of(pressed)

    def test_the_panels_stop_is_latched_until_the_plc_resets_it(self):
        self.run_first()
        for number in self.numbers:
            station = self.first[number]
            self.assertEqual(self.press(number, "quick_stop"), 0)
            self.until("it is told", lambda station=station: not station.MoveVelocity.Busy)
            self.assertEqual(self.first.end(number, "MoveVelocity"), "CommandAborted")
            self.until_motor_stands(number)
            self.until("the power, too", lambda station=station: station.Power.Error)
            self.assertEqual(station.Power.ErrorID, 0x208)
            self.assertTrue(station.ReadStatus.Stopping)
            self.assert_fails(self.first, number, "MoveVelocity", 9, Velocity=SPEED)
            self.first.do(number, "Halt")
            self.assert_stays(number)
            self.assertEqual((station.Power.ErrorID, station.ReadStatus.Stopping), (0x208, True), "a halt clears nobody else's latch")
            self.first.do(number, "Reset")
            self.until("it is ready", lambda station=station: station.Power.Status and not station.Power.Error)
        self.run_first()

    def test_a_plc_that_asks_for_nothing_leaves_the_axes_to_the_panel(self):
        self.until("the PLC is ready", lambda: all(self.first[number].Axis.Ready for number in self.numbers))
        for number in self.numbers:
            self.assertEqual(self.press(number, "enable"), 0)
            self.until("the PLC sees it", lambda number=number: self.first[number].ReadStatus.Standstill)
            self.assertEqual(self.first[number].Axis.Owner, 2)
            self.assertFalse(self.first[number].Power.Error, "which is not its business")
            self.assert_fails(self.first, number, "MoveAbsolute", NOT_OWNER, Position=TURN)
            self.assertEqual(self.press(number, "enable", False), 0)

    def test_the_panel_may_not_move_what_the_plc_owns(self):
        self.run_first()
        for number in self.numbers:
            self.assertEqual(self.press(number, "enable", True), 6)
            with self.assertRaises(Refused):
                self.panel[number].set(target_velocity=0)
            self.cycles(5)
            self.assertTrue(self.first[number].MoveVelocity.InVelocity)


if __name__ == "__main__":
    main()
