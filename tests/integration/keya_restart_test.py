# SPDX-License-Identifier: Apache-2.0
"""A Keya restarts while both of its motors run: both axes are told, every motion has ended for good, and nothing is enabled by the
gateway, however short the restart was."""
from keya_stage import CANOPEN, KEYA_CAN, MANY_KEEP_ALIVES, RS232, RS485, SPEED, KeyaStory, main, on
from modbus import DISABLED, FAILED, ONLINE
from processes import until

OVERCURRENT = "0x0040"  # fault 7: cleared by a disabling


class RestartsInMotion(KeyaStory):
    def restart(self, interface, boot_ms):
        self.begin(interface, "--boot-ms", str(boot_ms))
        motions = self.run_both()
        self.ask("restart")
        self.assertEqual(self.ask("restarts"), "1")

        def is_up_and_stands():
            state = self.ask("state")
            self.assertIn(state, ("booting", "disabled disabled"))
            return state != "booting" and self.speeds() == [0, 0]

        until("it is up, and its motors have coasted", is_up_and_stands)
        where = self.positions()
        for axis, motion in zip(self.seen, motions):
            axis.until(link_state=ONLINE, axis_state=DISABLED, motion_state=FAILED, motion_id=motion)
        self.assert_nothing_is_enabled_by_itself(where)
        for axis, position in zip(self.seen, where):
            axis.until(position_actual=position)
        self.assert_fresh_enable_works()


class RestartsSlowly(RestartsInMotion):
    boot_ms = 2000

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_nothing_is_enabled_by_itself(self, interface):
        self.restart(interface, self.boot_ms)


class RestartsAtOnce(RestartsInMotion):
    """Faster than anybody could call it offline."""

    boot_ms = 20

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_nothing_is_enabled_by_itself(self, interface):
        self.restart(interface, self.boot_ms)


class OneMotorTrips(KeyaStory):
    """A fault of one motor is no business of the other's: nothing that is sent for the neighbour switches it on again."""

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_the_other_runs_on_and_this_one_stays_disabled(self, interface):
        self.begin(interface)
        self.run_both()
        left, right = self.axes
        self.ask("fault", "A", OVERCURRENT)
        left.until(error_code=0x2310, vendor_error=0x0040, motion_state=FAILED)
        self.assertEqual(self.enabled(), [False, True])
        self.run_axis(right, 2 * SPEED)
        self.ask("clear", "A", OVERCURRENT)
        self.let_pass(MANY_KEEP_ALIVES)
        self.assertEqual((self.enabled(), self.speeds(), self.trips()), ([False, True], [0, 2 * SPEED], 0))
        if not interface.on_can:  # a frame names both motors: whether its 0 for one is the disabling that clears is not stated
            right.command("disable")
        enabled = self.enabled()
        left.command("fault_reset")
        left.until(axis_state=DISABLED, error_code=0)
        self.assertEqual(self.enabled(), enabled)
        self.enable(left)
        self.assertEqual(self.enabled(), [True, enabled[1]])
        self.run_axis(left)


if __name__ == "__main__":
    main()
