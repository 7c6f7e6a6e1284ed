# SPDX-License-Identifier: Apache-2.0
"""Who may command an axis when several want to: DDS writers by their strength, and DDS beside Modbus clients."""
from dds_stage import DONE, FAST, LEASE, NOT_OWNER, RPM, VENDORS, DdsStory, main
from lease_stage import ME
from modbus import Axis
from processes import until


class BesideModbus(DdsStory):
    lines_of = ("serial", "modbus")

    def setUp(self):
        super().setUp()
        self.begin()
        self.plc = self.peer()

    def test_what_a_modbus_client_owns_no_dds_writer_takes(self):
        for vendor in self.each_vendor():
            peer = self.commander(vendor)
            for number in self.numbers:
                axis = Axis(self.plc, number)
                self.set_running(axis)
                for command, targets in (("run_velocity", {"target_velocity": -300 * RPM}), ("enable", {}), ("take_over", {}),
                                         ("none", {"target_velocity": 0}), ("release", {}), ("jog_reverse", {"jog_velocity": RPM})):
                    self.plc.gateway()
                    self.at = f"{vendor}: {command}"
                    result, _ = peer.answer(peer.ask(number, command, **targets))
                    self.assertEqual(result, NOT_OWNER)
                self.assertGreater(self.speed(number), 0)
                self.assertEqual(axis.get("owner"), ME)
                peer.do(number, "quick_stop")  # open to everybody
                self.until_it_stands(number)
                self.assertEqual(axis.get("owner"), ME)
                axis.command("disable")
                axis.command("release")


class Strengths(DdsStory):
    """Two writers of one axis: DDS's exclusive ownership, and the lease that goes with it."""

    lines_of = ("serial",)
    lease = {"timeout_ms": 10000}

    def setUp(self):
        super().setUp()
        self.begin()

    def test_a_stronger_one_takes_the_axis_and_when_it_dies_its_motor_stops_and_the_weaker_may_go_on(self):
        events = self.peer_of(FAST).read("axis_event")
        for vendors in (VENDORS, VENDORS[::-1]):
            self.at = vendors
            weak, strong = (self.commander(vendor, "strength", strength) for vendor, strength in zip(vendors, (5, 10)))
            self.run_by_dds(weak, 1, rpm=200)
            self.until_it_turns_at(1, 200)
            place = events.now()
            strong.do(1, "run_velocity", target_velocity=-200 * RPM)
            self.until_it_turns_at(1, -200)
            events.sample("axis_event", since=place, axis=1, kind=LEASE)
            for _ in range(5):
                self.assert_one_answer(weak, weak.ask(1, "run_velocity", target_velocity=300 * RPM), NOT_OWNER)
            strong.process.kill()
            strong.ended()
            # It cannot take the axis before the dead one's lease has run out, and is told so each time.
            results = []

            def free(weak=weak, results=results):
                results.append(weak.answer(weak.ask(1, "enable"))[0])
                return results[-1] == DONE

            until("the weaker one may command again", free)
            self.assertEqual(set(results), {NOT_OWNER, DONE})
            weak.do(1, "run_velocity", target_velocity=200 * RPM)
            self.until_it_turns_at(1, 200)
            self.let_go(weak, 1)
        self.at = None


if __name__ == "__main__":
    main()
