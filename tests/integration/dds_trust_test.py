# SPDX-License-Identifier: Apache-2.0
"""Which command of which writer is carried out, by which gateway: two gateways in a domain, and commands that come too late."""
import os
import signal
import time

from dds_stage import CYCLONE, DONE, FAST, NEVER_STARTED, NOT_NOW, RPM, STATE_UNSUITABLE, VENDORS, DdsStory, main
from lease_stage import MACHINES
from modbus import DISABLED, Axis
from processes import until

NAME_TAKEN = 22
ALARM_NAME_TAKEN = 1 << 13


class TwoGateways(DdsStory):
    """Each has one of the two drives, and calls it axis 1."""

    lines_of = ("serial", "modbus")

    def setUp(self):
        super().setUp()
        self.simulate({line: MACHINES[line][0] for line in self.lines_of})
        self.both = self.buses()
        for entry in self.both:
            entry["drives"][0]["axes"][0]["axis"] = 1
        self.watchers = []

    def begin_one(self, name):
        place = len(self.watchers)
        self.gateway_name = name
        self.configure(buses=[self.both[place]], name=f"gateway_{place}.json")
        self.run_gateway()
        self.client = self.peer("127.0.0.9")
        self.watchers.append(self.client)
        self.until_online()
        return self.gateway

    def enabled(self):
        """Of both."""
        return ["enabled" in Axis(watcher, 1).inputs() for watcher in self.watchers]

    def alarmed(self):
        return [bool(watcher.gateway()["alarms"] & ALARM_NAME_TAKEN) for watcher in self.watchers]


class OfTwoNames(TwoGateways):
    def test_each_does_what_is_for_it(self):
        for name in ("cell_7", "cell_8"):
            self.begin_one(name)
        for vendor in self.each_vendor():
            self.gateway_name = "cell_7"
            seventh = self.commander(vendor)
            self.gateway_name = "cell_8"
            eighth = self.commander(vendor)
            self.prepare_by_dds(seventh, 1)
            self.assert_one_answer(seventh, seventh.ask(1, "enable"), DONE)
            self.assertEqual(self.enabled(), [True, False])
            seventh.do(1, "run_velocity", target_velocity=200 * RPM)
            self.until_it_turns(1)
            self.assert_one_answer(eighth, eighth.ask(1, "quick_stop"), DONE)
            self.assertNotEqual(self.speed(1), 0, "a stop for another gateway")
            self.assertEqual(self.speed(2), 0)
            seventh.do(1, "disable")
            self.until_it_stands(1)
            seventh.do(1, "release")
            eighth.do(1, "enable")
            self.assertEqual(self.enabled(), [False, True])
            eighth.do(1, "disable")
            eighth.do(1, "release")
        self.assertEqual(self.alarmed(), [False, False])


class OfOneName(TwoGateways):
    name = "cell_7"

    def test_they_see_each_other_and_start_nothing(self):
        self.begin_one(self.name)
        masters = [self.commander(vendor, "strength", 1 + i) for i, vendor in enumerate(VENDORS)]
        self.run_by_dds(masters[0], 1)
        second = self.begin_one(self.name)
        until("both say so", lambda: all(self.alarmed()))
        self.assertNotEqual(self.speed(1), 0, "what runs goes on")
        for master in masters:
            self.assertIn(NAME_TAKEN, [reply["result"] for reply in self.all_answers(master, master.ask(1, "enable"))])
        self.assertEqual(self.enabled(), [True, False])
        masters[0].ask(1, "quick_stop")
        self.until_it_stands(1)
        second.process.terminate()
        second.ended()
        self.watchers.pop()
        until("its name is its own again", lambda: not any(self.alarmed()))
        masters[1].do(1, "enable")
        self.let_go(masters[1], 1)

    def all_answers(self, master, request):
        master.answer(request)
        return master.answers(request)


class WithoutName(OfOneName):
    name = ""

    def test_they_see_each_other_and_start_nothing(self):
        super().test_they_see_each_other_and_start_nothing()


class TooLate(DdsStory):
    """axisgate-dds stands still while commands come to it: what the network or the socket holds back is as old."""

    lines_of = ("serial",)
    max_age_ms = 1500

    def setUp(self):
        super().setUp()
        self.begin()

    def held_back(self, ask):
        """What `ask` sends arrives when it is too old. Its result."""
        process = self.dds_process()
        self.addCleanup(os.kill, process, signal.SIGCONT)
        os.kill(process, signal.SIGSTOP)
        request = ask()
        self.let_pass(1.2 * self.max_age_ms / 1000)
        os.kill(process, signal.SIGCONT)
        return request

    def do_now(self, peer, *what, **members):
        """A busy machine may make any command late."""
        until(f"{what} is in time", lambda: peer.answer(peer.ask(1, *what, **members))[0] == DONE)

    def test_an_enable_is_not_carried_out(self):
        for vendor in self.each_vendor():
            peer = self.commander(vendor)
            request = self.held_back(lambda peer=peer: peer.ask(1, "enable"))
            self.assert_one_answer(peer, request, NEVER_STARTED)
            self.assertEqual(self.watched(1).get("axis_state"), DISABLED)
            self.do_now(peer, "enable")
            self.do_now(peer, "disable")
            self.do_now(peer, "release")

    def test_a_stop_is(self):
        for vendor in self.each_vendor():
            peer = self.commander(vendor)
            self.do_now(peer, profile_acceleration=1000 * RPM, profile_deceleration=1000 * RPM)
            self.do_now(peer, "enable")
            self.do_now(peer, "run_velocity", target_velocity=200 * RPM)
            self.until_it_turns(1)
            request = self.held_back(lambda peer=peer: peer.ask(1, "quick_stop"))
            self.assert_one_answer(peer, request, DONE)
            self.until_it_stands(1)
            request = self.held_back(lambda peer=peer: peer.ask(1, "release"))
            self.assert_one_answer(peer, request, DONE)
            self.watched(1).until(owner=0)


class Strangers(DdsStory):
    """A stop of one that owns nothing, beside an owner that commands without pause."""

    lines_of = ("serial",)
    commands = 20  # more than the eight that may wait at an axis: the rest is refused as busy

    def test_is_in_effect_before_all_that_a_live_and_stronger_owner_asks_after_it(self):
        self.begin()
        process = self.dds_process()
        self.addCleanup(os.kill, process, signal.SIGCONT)
        for vendor, other in ((FAST, CYCLONE), (CYCLONE, FAST)):
            self.at = vendor
            owner = self.commander(vendor, "strength", 9)
            stranger = self.commander(other, "shared")
            self.run_by_dds(owner, 1)
            before = [owner.ask(1, target_velocity=(200 + i) * RPM) for i in range(self.commands)]
            # What two programs send at the same time comes in any order. Held back, it waits in the order in which it was sent.
            os.kill(process, signal.SIGSTOP)
            stop = stranger.ask(1, "quick_stop")
            stranger.until_written()
            after = [owner.ask(1, "run_velocity", target_velocity=(200 + i) * RPM) for i in range(self.commands)]
            owner.until_written()
            os.kill(process, signal.SIGCONT)
            self.assertEqual(stranger.answer(stop)[0], DONE)
            self.assertLessEqual({owner.answer(request)[0] for request in after}, {STATE_UNSUITABLE, NOT_NOW})
            self.until_it_stands(1)
            for request in before:
                owner.answer(request)
            self.let_go(owner, 1)
        self.at = None


if __name__ == "__main__":
    main()
