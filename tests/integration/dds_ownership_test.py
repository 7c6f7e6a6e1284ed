"""Who may command an axis when several want to: DDS writers by their strength, and DDS beside Modbus clients."""
from dds_stage import CYCLONE, DONE, FAST, LEASE, NOT_OWNER, RPM, VENDORS, DdsStory, main
from lease_stage import ANOTHER, ME, NOBODY
from modbus import BUSY, Axis
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

    def test_what_a_dds_writer_owns_no_modbus_client_takes(self):
        for vendor in self.each_vendor():
            peer = self.commander(vendor)
            for number in self.numbers:
                axis = Axis(self.plc, number)
                self.run_by_dds(peer, number)
                self.assertEqual(axis.get("owner"), ANOTHER)
                with self.refused(BUSY):
                    axis.set(target_velocity=-300_000)
                with self.refused(BUSY):
                    axis.set(target_position=1)
                self.assertGreater(self.speed(number), 0)
                axis.coil("quick_stop")  # open to everybody
                self.until_it_stands(number)
                self.assertEqual(axis.get("owner"), ANOTHER)
                self.let_go(peer, number)
                axis.until(owner=NOBODY)
                axis.set(target_velocity=0)
                axis.command("release")


class Strengths(DdsStory):
    """Two writers of one axis: DDS's exclusive ownership, and the lease that goes with it."""

    lines_of = ("serial",)
    lease = {"timeout_ms": 5000}
    lives_by = ("manual", 3000)  # the library tells apart whose assertion it hears

    def setUp(self):
        super().setUp()
        self.begin()

    def stronger_wins(self, weak_vendor, strong_vendor):
        number = 1
        events = self.peer_of(FAST).read("axis_event")
        weak = self.commander(weak_vendor, "strength", 5, *self.lives_by)
        self.run_by_dds(weak, number, rpm=200)
        self.until_it_turns_at(number, 200)
        strong = self.commander(strong_vendor, "strength", 10, *self.lives_by)
        self.assertGreater(self.speed(number), 0, "that it is there changes nothing")
        place = events.now()
        strong.do(number, "run_velocity", target_velocity=-200 * RPM)
        self.until_it_turns_at(number, -200)
        events.sample("axis_event", since=place, axis=number, kind=LEASE)
        # What the weaker one writes from now on is dropped by DDS itself, or refused: it is done in no case.
        unanswered = [weak.ask(number, "run_velocity", target_velocity=300 * RPM) for _ in range(5)]
        until("still turning back", lambda: strong.do(number, "none", target_velocity=-250 * RPM) == 0)
        self.until_it_turns_at(number, -250)
        for request in unanswered:
            self.assertIn([reply["result"] for reply in weak.answers(request)], ([], [NOT_OWNER]))
        return weak, strong

    def both(self, weak_vendor, strong_vendor):
        weak, strong = self.stronger_wins(weak_vendor, strong_vendor)
        # In good order: it stops, lets go, and leaves.
        strong.do(1, "disable")
        strong.do(1, "release")
        strong.leave()
        self.weaker_again(weak)

    def weaker_again(self, weak):
        """Once the stronger one is gone for DDS as well."""
        def accepted():
            request = weak.ask(1, "enable")
            try:
                weak.wait("sample", "command_reply", lambda told: told["data"]["request_id"] == request, seconds=0.5)
            except AssertionError:
                return False  # still dropped
            return weak.answers(request)[0]["result"] == DONE

        until("the weaker one may command again", accepted)
        weak.do(1, "run_velocity", target_velocity=200 * RPM)
        self.until_it_turns_at(1, 200)
        weak.do(1, "disable")
        self.until_it_stands(1)

    def test_fast_before_fast(self):
        self.both(FAST, FAST)

    def test_cyclone_before_cyclone(self):
        self.both(CYCLONE, CYCLONE)

    def test_cyclone_before_fast(self):
        self.both(FAST, CYCLONE)

    def test_fast_before_cyclone(self):
        self.both(CYCLONE, FAST)

    def test_a_stronger_one_that_dies_stops_its_motor_and_the_weaker_may_go_on(self):
        weak, strong = self.stronger_wins(CYCLONE, FAST)
        strong.process.kill()
        strong.ended()
        self.until_it_stands(1)
        self.watched(1).until_input("stop_latched")
        self.weaker_again(weak)


class Equals(DdsStory):
    lines_of = ("serial",)
    lease = {"timeout_ms": 5000}
    lives_by = ("manual", 3000)  # the library tells apart whose assertion it hears

    def test_while_one_has_the_axis_another_of_its_strength_has_not(self):
        self.begin()
        for vendors in (VENDORS, VENDORS[::-1]):
            self.at = vendors
            self.strength += 1
            same = ("strength", self.strength, *self.lives_by)
            one, other = (self.commander(vendor, *same) for vendor in vendors)
            self.run_by_dds(one, 1)
            for _ in range(5):
                other.ask(1, "run_velocity", target_velocity=-300 * RPM)
            other.answer(other.ask(other.nowhere, "enable"))  # after those
            replies = other.samples("command_reply", axis=1, writer=other.guids["axis_command"])
            self.assertLessEqual({reply["result"] for reply in replies}, {NOT_OWNER})
            self.assertGreater(self.speed(1), 0)
            Axis(self.watcher, 1).coil("quick_stop")
            self.until_it_stands(1)
            one.process.kill()
            other.process.kill()
            self.watched(1).until(owner=NOBODY)


if __name__ == "__main__":
    main()
