# SPDX-License-Identifier: Apache-2.0
"""The cable of the network between a DDS master and the gateway is cut: the motor stops by the lease, a successor has the axis, and what
the old master wrote meanwhile moves and enables nothing when the cable is back. Each vendor is master and successor of each; one cut is
for all of them, each pair with a motor of its own."""
from dds_succession_stage import MASTER, STRENGTHS, Succession, in_host, make_network  # first: see own_network

import itertools

from dds_stage import CYCLONE, DONE, FAST, NEVER_STARTED, NOT_OWNER, RPM, VENDORS, main
from lease_stage import MACHINES, NOBODY
from modbus import DISABLED
from processes import until

PAIRS = dict(enumerate(itertools.product(VENDORS, VENDORS), 1))  # axis: whose master, whose successor
LINES = {f"line_{number}": MACHINES["serial"] for number in PAIRS}
MACHINES.update(LINES)
# So that a master's library does not take the gateway for dead, nor is taken for it, while the cable is cut: which of the two sides finds
# the other again how soon after that is the libraries' matter (docs/dds/masters.md).
PATIENT = {FAST: (), CYCLONE: ("env", "CYCLONEDDS_URI=<Discovery><LeaseDuration>600s</LeaseDuration><SPDPInterval>1s</SPDPInterval></Discovery>")}
FOUND_AGAIN = 300  # seconds


def setUpModule():
    make_network()


class Cable(Succession):
    lines_of = tuple(LINES)
    lease = {"timeout_ms": 3000}
    max_age_ms = 2500  # less than a lease: what is written after the cut is too old when the lease has run out

    def setUp(self):
        super().setUp()
        self.begin()
        self.addCleanup(self.mend)
        self.masters = {vendor: self.node(vendor, *in_host(), *PATIENT[vendor]) for vendor in VENDORS}
        self.successors = {vendor: self.node(vendor) for vendor in VENDORS}
        for vendor in VENDORS:
            self.masters[vendor].command_with(*MASTER.get(self.relation, ("strength", 5)))
            self.successors[vendor].command_with(*STRENGTHS[self.relation])

    def master(self, number):
        return self.masters[PAIRS[number][0]]

    def successor(self, number):
        return self.successors[PAIRS[number][1]]

    def all_ask(self, peer_of, *what, **members):
        return {number: peer_of(number).ask(number, *what, **members) for number in PAIRS}

    def all_do(self, peer_of, *what, **members):
        for number, request in self.all_ask(peer_of, *what, **members).items():
            self.at = PAIRS[number], what
            self.assertEqual(peer_of(number).answer(request)[0], DONE)

    def all_run(self, peer_of, rpm):
        self.all_do(peer_of, "enable", profile_acceleration=1000 * RPM, profile_deceleration=1000 * RPM)
        self.all_do(peer_of, "run_velocity", target_velocity=rpm * RPM)
        for number in PAIRS:
            self.until_it_turns_at(number, rpm)

    def heard(self, number, request):
        """The results that this request of the master's has, as its successor hears them."""
        return [reply["result"] for reply in self.successor(number).samples(
            "command_reply", request_id=request, writer=self.master(number).guids["axis_command"])]

    def until_the_masters_are_heard(self, meanwhile=lambda: None):
        """What they ask now is answered, and so is all that they wrote before, if it has come at all."""
        asked = {number: [] for number in PAIRS}

        def answered():
            meanwhile()
            for number, requests in asked.items():
                requests.append(self.master(number).write("axis_command", axis=self.master(number).nowhere))
            return all(any(self.heard(number, request) for request in requests) for number, requests in asked.items())

        until("the masters are heard", answered, FOUND_AGAIN)

    def written(self):
        """How often the gateway wrote what moves or enables."""
        return sum(self.sim.writes(f"{line}/1") for line in self.lines_of)

    def assert_too_late(self, late):
        for number, request in late.items():
            self.at = PAIRS[number]
            self.assertEqual(self.heard(number, request), [NEVER_STARTED])

    def written_after_the_cable_is_back(self, meanwhile=lambda: None):
        """Until the masters are heard."""
        before = self.written()
        self.mend()
        self.until_the_masters_are_heard(meanwhile)
        return self.written() - before


class Equal(Cable):
    def test_its_successor_has_the_axis_and_what_comes_late_moves_nothing(self):
        self.all_run(self.master, 300)
        self.all_do(self.master, target_velocity=250 * RPM)
        self.cut()
        late = [self.all_ask(self.master, "enable"), self.all_ask(self.master, "run_velocity", target_velocity=250 * RPM)]
        for number in PAIRS:
            self.at = PAIRS[number]
            self.assert_stopped_for_good(number)
            self.until_told(number, "has run out")
        self.all_run(self.successor, -200)
        self.assertEqual(self.written_after_the_cable_is_back(lambda: self.all_do(self.successor, target_velocity=-200 * RPM)), 0)
        for requests in late:
            self.assert_too_late(requests)
        for number in PAIRS:
            self.until_it_turns_at(number, -200)
        for number, request in self.all_ask(self.master, "run_velocity", target_velocity=250 * RPM).items():
            self.at = PAIRS[number]
            until("it is heard", lambda number=number, request=request: self.heard(number, request))
            self.assertEqual(self.heard(number, request), [NOT_OWNER])
            self.until_it_turns_at(number, -200)


class NobodyElse(Cable):
    def test_an_enable_that_comes_late_does_not_enable_an_axis_that_is_free(self):
        self.cut()
        late = self.all_ask(self.master, "enable")
        self.let_pass(1.2 * self.max_age_ms / 1000)
        self.assertEqual(self.written_after_the_cable_is_back(), 0)
        self.assert_too_late(late)
        for number in PAIRS:
            self.at = PAIRS[number]
            self.watched(number).until(axis_state=DISABLED, owner=NOBODY)
        self.at = None


if __name__ == "__main__":
    main()
