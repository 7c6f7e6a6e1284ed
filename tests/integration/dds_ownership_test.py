# SPDX-License-Identifier: Apache-2.0
"""Who may command an axis when several want to: DDS writers by their strength, and DDS beside Modbus clients."""
import collections
import itertools
import signal

from dds_stage import CYCLONE, DONE, FAST, LEASE, NO_AXIS, NOT_NOW, NOT_OWNER, RPM, VENDORS, DdsStory, fits, main
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
    lease = {"timeout_ms": 20000}

    def setUp(self):
        super().setUp()
        self.begin()

    def stronger_wins(self, weak_vendor, strong_vendor):
        number = 1
        events = self.peer_of(FAST).read("axis_event")
        weak = self.commander(weak_vendor, "strength", 5)
        self.run_by_dds(weak, number, rpm=200)
        self.until_it_turns_at(number, 200)
        strong = self.commander(strong_vendor, "strength", 10)
        self.assertGreater(self.speed(number), 0, "that it is there changes nothing")
        place = events.now()
        strong.do(number, "run_velocity", target_velocity=-200 * RPM)
        self.until_it_turns_at(number, -200)
        events.sample("axis_event", since=place, axis=number, kind=LEASE)
        for _ in range(5):
            self.assert_one_answer(weak, weak.ask(number, "run_velocity", target_velocity=300 * RPM), NOT_OWNER)
        strong.do(number, "none", target_velocity=-250 * RPM)
        self.until_it_turns_at(number, -250)
        return weak, strong

    def both(self, weak_vendor, strong_vendor):
        weak, strong = self.stronger_wins(weak_vendor, strong_vendor)
        # In good order: it stops, lets go, and leaves.
        strong.do(1, "disable")
        strong.do(1, "release")
        strong.leave()
        self.weaker_again(weak)

    def weaker_again(self, weak):
        """The next that it asks is done."""
        weak.do(1, "enable")
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
        # It cannot take the axis before the dead one's lease has run out, and is told so each time.
        results = []

        def free():
            results.append(weak.answer(weak.ask(1, "enable"))[0])
            return results[-1] == DONE

        until("the weaker one may command again", free)
        self.assertEqual(set(results), {NOT_OWNER, DONE})
        self.weaker_again(weak)


class Equals(DdsStory):
    lines_of = ("serial",)
    lease = {"timeout_ms": 3000}

    def setUp(self):
        super().setUp()
        self.begin()

    def pairs(self):
        """A master and one of its strength, of each vendor before each."""
        for vendors in itertools.product(VENDORS, VENDORS):
            self.at = vendors
            master, other = (self.commander(vendor, *self.ownership) for vendor in vendors)
            yield master, other
            self.watched(1).until(owner=NOBODY)
        self.at = None

    ownership = ("strength", 7)

    def test_one_never_takes_the_axis_from_another_while_its_lease_runs_and_stops_it_at_any_time(self):
        for master, other in self.pairs():
            self.prepare_by_dds(master, 1)
            master.do(1, "enable")
            for peer, rpm in ((master, 200), (other, -300)):
                result = peer.answer(peer.ask(1, "run_velocity", target_velocity=rpm * RPM))[0]
                self.assertEqual(result, DONE if peer is master else NOT_OWNER)
                self.until_it_turns_at(1, 200)
            other.do(1, "quick_stop")
            self.until_it_stands(1)
            master.do(1, "enable")
            self.let_go(master, 1)
            master.leave()
            other.leave()


class Shared(Equals):
    """Plain publishers: ROS 2 knows no others."""

    ownership = ("shared",)

    def test_a_stronger_one_takes_their_axis(self):
        for vendor in self.each_vendor():
            plain = self.commander(vendor, "shared")
            strong = self.commander(vendor, "strength", 1)  # before the lease begins: to find each other takes some seconds at times
            self.run_by_dds(plain, 1)
            strong.do(1, "run_velocity", target_velocity=-200 * RPM)
            self.until_it_turns_at(1, -200)
            self.assert_one_answer(plain, plain.ask(1, "run_velocity", target_velocity=200 * RPM), NOT_OWNER)
            self.let_go(strong, 1)


class ManyRequests(DdsStory):
    """20,000 commands of two writers of each vendor, none without its one reply, and that the right one: of an axis that is not there, and of
    one that the first of them owns."""

    lines_of = ("serial",)
    each = 5000
    # In one go, to the axis that is not there and to the one that is. A reader keeps 64 replies of an axis, and the second has those of all
    # four; the owner waits for the drive each time.
    owner_asks, another_asks = (61, 1), (50, 12)
    # So many requests are remembered for 10 s; beyond, a new one is refused as busy.
    remembered = 8192

    def test_each_of_them_has_one_reply(self):
        self.begin()
        peers = [self.commander(vendor, *how) for vendor in VENDORS for how in (("strength", 3), ())]
        owner = peers[0]
        owner.do(1, "enable")
        wanted = {peer: {} for peer in peers}
        while len(wanted[owner]) < self.each:
            places = {peer: peer.now() for peer in peers}
            last = {}
            # They also knocked, and of one round any may come first.
            busy = [NOT_NOW] if sum(map(len, wanted.values())) + 10 * sum(self.another_asks) > self.remembered else []
            for peer in peers:
                nowhere, there = self.owner_asks if peer is owner else self.another_asks
                for _ in range(nowhere):
                    wanted[peer][peer.ask(peer.nowhere, "enable")] = [NO_AXIS, *busy]
                for _ in range(there):
                    wanted[peer][peer.ask(1, target_velocity=100 * RPM)] = [DONE if peer is owner else NOT_OWNER, *busy]
                last[peer] = max(wanted[peer])
            for peer in peers:
                for request in (last[peer] - (self.owner_asks if peer is owner else self.another_asks)[1], last[peer]):
                    peer.answer(request, places[peer])
        for peer in peers:
            self.at = peer.name
            results = collections.defaultdict(list)
            for reply in peer.samples("command_reply", writer=peer.guids["axis_command"]):
                results[reply["request_id"]].append(reply["result"])
            wrong = {request: results[request] for request, allowed in wanted[peer].items()
                     if len(results[request]) != 1 or results[request][0] not in allowed}
            self.assertEqual(wrong, {})
        self.at = None


class FallenBehind(DdsStory):
    """A reader of replies that stands still, beside one that does not. The gateway keeps the newest replies of each axis for it."""

    lines_of = ("serial",)
    kept = 64
    rounds = 4

    def test_it_hears_the_newest_of_each_axis_and_holds_up_nobody(self):
        self.begin()
        asker = self.commander(FAST)
        for vendor in self.each_vendor():
            deaf = self.peer_of(vendor).read("command_reply")
            self.addCleanup(deaf.send, signal.SIGCONT)
            until("it has heard the newest of those that it has missed", lambda deaf=deaf: self.misses_some(deaf, asker))

    def misses_some(self, deaf, asker):
        """False: it was away for so long that it counted as gone."""
        mine = {"axis": asker.nowhere, "writer": asker.guids["axis_command"]}

        def hears(request, seconds):
            try:
                deaf.wait("sample", "command_reply", lambda told: fits(told["data"], {**mine, "request_id": request}), seconds=seconds)
                return True
            except AssertionError:
                return False

        until("both know each other", lambda: hears(asker.ask(asker.nowhere, "enable"), 0.5))
        deaf.send(signal.SIGSTOP)
        for _ in range(self.rounds):
            requests = [asker.ask(asker.nowhere, "enable") for _ in range(self.kept // 2)]
            for request in requests:
                asker.answer(request)
        deaf.send(signal.SIGCONT)
        if not hears(requests[-1], 5):
            return False
        heard = [reply["request_id"] for reply in deaf.samples("command_reply", **mine)]
        heard = heard[:heard.index(requests[-1]) + 1]
        self.assertEqual(heard[-self.kept:], list(range(requests[-1] - self.kept + 1, requests[-1] + 1)))
        return True


if __name__ == "__main__":
    main()
