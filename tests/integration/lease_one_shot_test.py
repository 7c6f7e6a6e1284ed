# SPDX-License-Identifier: Apache-2.0
""""client": "address": all connections of one host are one client, so that one-shot tools own what they have begun."""
from lease_stage import ANOTHER, ME, PANEL_1, PLC, RPM, Machine, main
from modbus import BUSY, Axis, mbpoll


class OneShot(Machine):
    listener_options = {"client": "address"}
    lease = {"timeout_ms": 5000}

    def setUp(self):
        super().setUp()
        self.begin()

    def once(self, number, do, address=PLC):
        """On a connection of its own."""
        client = self.peer(address)
        try:
            return do(Axis(client, number))
        finally:
            client.close()

    def assert_refused(self, axis):
        with self.refused(BUSY):
            axis.set(target_velocity=0)


class Connections(OneShot):
    def test_connections_of_one_address_are_one_owner(self):
        for number in self.each():
            self.once(number, self.enable)
            self.once(number, lambda axis: axis.set(target_velocity=300 * RPM))
            self.once(number, lambda axis: axis.command("run_velocity"))
            self.until_it_turns_at(number, 300)
            self.assertEqual(self.once(number, lambda axis: axis.get("owner")), ME)
            self.assertEqual(self.once(number, lambda axis: axis.get("owner"), PANEL_1), ANOTHER)
            self.once(number, self.assert_refused, PANEL_1)
            first, second = Axis(self.peer(), number), Axis(self.peer(), number)
            for axis in (first, second):  # at the same time, too
                self.assertIn("owned_by_me", axis.inputs())
                axis.set(target_velocity=200 * RPM)
            self.assertFalse(self.leases_told(number, "is back"), "it was never another client")
            self.once(number, lambda axis: axis.command("disable"))
            self.until_it_stands(number)
            self.once(number, lambda axis: axis.command("release"))

    def test_mbpoll_owns_what_it_has_enabled(self):
        for number in self.each():
            first = 100 * number
            mbpoll(self.ports[0], "0", first, 1)
            self.assertEqual(mbpoll(self.ports[0], "4", first + 28), [ME])
            mbpoll(self.ports[0], "4:int", first + 44, 300 * RPM)
            mbpoll(self.ports[0], "0", first + 7, 0)
            mbpoll(self.ports[0], "0", first + 7, 1)
            self.until_it_turns_at(number, 300)
            self.once(number, self.assert_refused, PANEL_1)
            mbpoll(self.ports[0], "0", first + 2, 1)
            self.until_it_stands(number)


class NoMoreShots(OneShot):
    lease = {"timeout_ms": 1000}

    def test_a_host_that_does_not_come_again_is_a_master_that_is_gone(self):
        for number in self.each():
            self.once(number, self.set_running)
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.assert_it_can_be_had_again(number)


if __name__ == "__main__":
    main()
