# SPDX-License-Identifier: Apache-2.0
"""Masters of both vendors that go in three ways, and successors of both that are as strong, stronger, weaker, or plain publishers: the
successor's stop is heard at once, its enable when the axis is free, and a master that comes back is treated as its strength has it. The
fourth way, a cut cable, is dds_cable_test.py."""
from dds_succession_stage import Succession, make_network  # first: see own_network

import itertools

from dds_stage import DONE, NOT_OWNER, RPM, VENDORS, main
from lease_stage import NOBODY
from processes import until


def setUpModule():
    make_network()


class Equal(Succession):
    lease = {"timeout_ms": 3000}
    takes_at_once = False  # a lease that runs is for a stronger one to take
    loses_it_again = False

    def setUp(self):
        super().setUp()
        self.begin()

    def each_pair(self):
        for vendors in itertools.product(VENDORS, VENDORS):
            self.at = vendors
            yield vendors
        self.at = None

    def succeed(self, way):
        for vendors in self.each_pair():
            master, successor = self.pair(vendors)
            self.go(way, master)
            self.assert_one_answer(successor, successor.ask(1, "quick_stop"), DONE)
            self.until_it_stands(1)
            results = []

            def free(successor=successor, results=results):
                results.append(successor.answer(successor.ask(1, "enable"))[0])
                return results[-1] == DONE

            until("its successor may enable", free)
            self.assertLessEqual(set(results), {DONE} if self.takes_at_once else {NOT_OWNER, DONE})
            self.run_back(successor)
            self.come_back(way, master)
            if way == "stand":
                self.assert_it_is_one_of_two(master, successor)
            self.let_go(successor, 1)
            self.watched(1).until(owner=NOBODY)
            successor.leave()
            if master.process.poll() is None and way != "leave":
                master.leave()

    def run_back(self, successor):
        successor.do(1, "run_velocity", target_velocity=-200 * RPM)
        self.until_it_turns_at(1, -200)

    def assert_it_is_one_of_two(self, master, successor):
        """The one that was taken for dead is there again."""
        master.knock("axis_command", "command_reply")
        successor.do(1, "enable")  # its own lease may have run out meanwhile
        self.run_back(successor)
        result, _ = master.answer(master.ask(1, "run_velocity", target_velocity=250 * RPM))
        self.assertEqual(result, DONE if self.loses_it_again else NOT_OWNER)
        self.until_it_turns_at(1, 250 if self.loses_it_again else -200)
        if self.loses_it_again:
            self.let_go(master, 1)

    def test_the_master_leaves_in_good_order(self):
        self.succeed("leave")

    def test_the_master_is_killed(self):
        self.succeed("kill")

    def test_the_master_stands_still_and_goes_on(self):
        self.succeed("stand")


class Stronger(Equal):
    relation = "stronger"
    takes_at_once = True

    def test_the_master_is_killed(self):  # a class is run where it has a test of its own; the others are inherited
        super().test_the_master_is_killed()


class Weaker(Equal):
    relation = "weaker"
    loses_it_again = True

    def test_the_master_is_killed(self):
        super().test_the_master_is_killed()


class Shared(Equal):
    relation = "shared"

    def test_the_master_is_killed(self):
        super().test_the_master_is_killed()


if __name__ == "__main__":
    main()
