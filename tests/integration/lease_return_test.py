# SPDX-License-Identifier: Apache-2.0
"""A PLC that comes back within its lease goes on as if it had never been away; another address gets nothing."""
from lease_stage import ANOTHER, ME, NOBODY, NOT_OWNER, PANEL_1, Machine, main
from modbus import ACTIVE, BUSY, Axis, Refused
from processes import until

HEARTBEAT = 8  # of the gateway


class Return(Machine):
    lease = {"timeout_ms": 2500}

    def setUp(self):
        super().setUp()
        self.begin()
        self.plc = self.peer()
        self.motions = {number: self.set_running(Axis(self.plc, number)) for number in self.numbers}

    def assert_goes_on(self, client, rpm):
        """All motors, as its own: none of them was stopped meanwhile."""
        for number in self.each():
            axis = Axis(client, number)
            self.until_it_turns_at(number, rpm)
            self.assertEqual((axis.get("motion_state"), axis.get("motion_id")), (ACTIVE, self.motions[number]))
            self.assertEqual((axis.get("owner"), self.watched(number).get("owner")), (ME, ANOTHER))
            self.assertEqual(axis.inputs() & {"enabled", "owned_by_me", "stop_latched"}, {"enabled", "owned_by_me"})
            self.assertFalse(self.leases_told(number, "has run out"))

    def stop_all(self, client):
        for number in self.numbers:
            Axis(client, number).command("quick_stop")
        for number in self.each():
            self.until_it_stands(number)


class FromItsOwnAddress(Return):
    def comes_back(self, words):
        again = self.peer()
        for number in self.numbers:
            Axis(again, number).set(target_velocity=400_000)
        self.assert_goes_on(again, 400)
        for number in self.numbers:
            self.until_told(number, words)
        self.keep_running(again, self.numbers, 1.2 * self.lease["timeout_ms"] / 1000)
        self.stop_all(again)

    def test_after_it_closed_its_connection(self):
        self.plc.close()
        self.comes_back("its connection had ended")

    def test_after_its_connection_was_reset(self):
        self.plc.reset()
        self.comes_back("its connection had ended")


class WhileItsOldConnectionIsHalfOpen(Return):
    """A cable was pulled: nobody has told the gateway that the old connection is dead."""

    lease = {"timeout_ms": 60000}

    def test_it_takes_over_after_a_halt_or_waits_for_the_lease(self):
        again = self.peer()
        self.plc.fall_silent()
        for number in self.each():
            axis = Axis(again, number)
            with self.refused(BUSY):  # the old connection may be alive, and somebody's hand on a switch
                axis.set(target_velocity=400_000)
            self.assertEqual(axis.get("command_result"), NOT_OWNER)
            axis.command("take_over")
            self.until_it_stands(number)
            self.until_told(number, "has taken the axis over from another connection of its address")
            self.assertEqual(axis.get("owner"), ME)
            self.set_running(axis, 400)
        for number in self.each():
            with self.refused(BUSY):  # and the old one, should it ever come alive, is another
                Axis(self.plc, number).set(target_velocity=300_000)
            self.assertEqual(Axis(self.plc, number).get("owner"), ANOTHER)
        self.stop_all(again)


class AfterASilence(Return):
    def test_the_lease_runs_out_and_the_axis_is_free(self):
        again = self.peer()
        self.plc.fall_silent()
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.enable(Axis(again, number))
        self.stop_all(again)


class WhileAnotherProgramOfItsAddressGoesOn(Return):
    """A monitor on the PLC's computer, which was there before and beats the gateway's heartbeat, keeps nothing of a dead PLC alive."""

    lines_of = ("serial",)

    def test_its_axes_stop_when_its_lease_is_over(self):
        monitor = self.peer()
        self.plc.gateway()
        self.plc.close()
        beats = 0

        def beat_until_they_stand():
            nonlocal beats
            beats += 1
            monitor.write(HEARTBEAT, beats)
            return all(self.speed(number) == 0 for number in self.numbers)

        until("all motors stand", beat_until_they_stand)
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.assertTrue(self.leases_told(number, "has run out"))


class FromAnotherAddress(Return):
    lease = {"timeout_ms": 3000}

    def test_it_gets_nothing_until_the_lease_has_run_out(self):
        other = self.peer(PANEL_1)
        for number in self.each():
            self.plc.gateway()
            self.assert_refused(Axis(other, number))
            self.until_it_turns_at(number, 300)
        self.plc.reset()
        for number in self.each():
            axis = Axis(other, number)
            if axis.get("owner") == ANOTHER:  # an orphan is not for everybody either
                self.assert_refused(axis)
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.assertEqual(Axis(other, number).get("owner"), NOBODY)
        for number in self.each():
            self.assert_it_can_be_had_again(number, PANEL_1)

    def assert_refused(self, axis):
        # An enable would be answered normally: the axis is enabled.
        for write in (lambda: axis.set(target_velocity=0), lambda: axis.set(jog_velocity=1)):
            try:
                write()
            except Refused as refused:
                self.assertEqual(refused.code, BUSY)
            else:
                self.fail(f"axis {axis.number} took a write of a client that does not own it")
            self.assertEqual((axis.get("command_result"), axis.get("owner")), (NOT_OWNER, ANOTHER))
            self.assertNotIn("owned_by_me", axis.inputs())


if __name__ == "__main__":
    main()
