# SPDX-License-Identifier: Apache-2.0
""""lease": null: nobody owns the axis, nobody is refused, and nothing runs out."""
from lease_stage import MACHINES, NOBODY, PANEL_1, PANEL_2, RPM, Machine, main
from modbus import ACTIVE, NO_ADDRESS, Axis


class LeasesOff(Machine):
    lease = None
    # Not the stepper: nothing else would ever stop it, and so the gateway does not leave it running alone.
    lines_of = tuple(line for line in MACHINES if line != "stepper")

    def setUp(self):
        super().setUp()
        self.begin()

    def test_nothing_runs_out(self):
        plc = self.peer()
        motions = {number: self.set_running(Axis(plc, number)) for number in self.numbers}
        plc.reset()
        self.let_pass(2)
        for number in self.each():
            self.assertNotEqual(self.speed(number), 0)
            block = self.watched(number).block()
            self.assertEqual((block["motion_state"], block["motion_id"]), (ACTIVE, motions[number]))
            self.assertEqual((block["owner"], block["lease_remaining_ms"]), (NOBODY, 0))
            self.assertNotIn("stop_latched", self.watched(number).inputs())

    def test_nobody_is_refused(self):
        plc, panel_1, panel_2 = self.peer(), self.peer(PANEL_1), self.peer(PANEL_2)
        for number in self.each():
            Axis(plc, number).set(target_velocity=300 * RPM)
            self.enable(Axis(panel_1, number))
            Axis(panel_2, number).command("run_velocity")
            self.until_it_turns_at(number, 300)
            Axis(panel_1, number).set(target_velocity=400 * RPM)
            self.until_it_turns_at(number, 400)
            for client in (plc, panel_1, panel_2):
                self.assertEqual(Axis(client, number).get("owner"), NOBODY)
                self.assertNotIn("owned_by_me", Axis(client, number).inputs())
            Axis(plc, number).command("disable")
            self.until_it_stands(number)

    def test_there_is_nothing_to_release_or_to_take_over(self):
        plc = self.peer()
        for number in self.each():
            for name in ("release", "take_over"):
                with self.refused(NO_ADDRESS):
                    Axis(plc, number).command(name)
            self.assertEqual(self.watched(number).get("supported_commands") >> 13 & 3, 0)


class LeaseOfOneMotorOnly(Machine):
    """Axis by axis: of two motors of one drive, one has a lease."""

    lines_of = ("keyacan",)
    lease = {"timeout_ms": 1000}

    def buses(self):
        buses = super().buses()
        buses[0]["drives"][0]["axes"][1]["lease"] = None
        return buses

    def test_only_that_one_is_stopped(self):
        self.begin()
        plc = self.peer()
        for number in self.numbers:
            self.set_running(Axis(plc, number))
        plc.close()
        self.assert_stopped_for_good(1)
        self.let_pass(1.5)  # the drive's own watchdog would have acted
        self.assertNotEqual(self.speed(2), 0)
        self.assertEqual(self.sim.ask("trips keyacan/1"), "0")


if __name__ == "__main__":
    main()
