# SPDX-License-Identifier: Apache-2.0
"""axis_event: faults, lost links and leases are told, and who comes late is told the newest sixteen of each axis."""
from dds_stage import BOOT, FAULT, LEASE, LINK, VENDORS, DdsStory, main
from lease_stage import NOBODY
from modbus import ERROR_STOP, ONLINE, Axis
from processes import until

KEPT = 16


class Events(DdsStory):
    def setUp(self):
        super().setUp()
        self.begin()
        self.readers = [self.peer_of(vendor).read("axis_event") for vendor in VENDORS]

    def until_all_hear(self, what, **where):
        for reader in self.readers:
            self.at = f"{reader.name}: {what}"
            event = reader.sample("axis_event", **where)
            self.assertTrue(event["text"])
            self.assertGreater(event["stamp"]["sec"], 1_000_000_000)
        self.at = None
        return event

    def assert_numbers_rise(self):
        for reader in self.readers:
            for axis in (0, 1, 2):
                numbers = [event["number"] for event in reader.samples("axis_event", axis=axis)]
                self.assertEqual(numbers, sorted(set(numbers)), f"axis {axis}")


class Told(Events):
    lease = {"timeout_ms": 1500}

    def test_a_fault_is_told_with_its_code(self):
        self.sim.ask("fault serial/1 2601 0x0100")
        code = self.watched(1).until(axis_state=ERROR_STOP)["error_code"]
        self.until_all_hear("a fault", axis=1, kind=FAULT, code=code)
        self.assert_numbers_rise()

    def test_a_lost_link_and_its_return_are_told(self):
        places = [reader.now() for reader in self.readers]
        self.sim.ask("unplug leadshine")
        self.until_all_hear("the link is lost", axis=2, kind=LINK)
        self.sim.ask("plug leadshine")
        self.watched(2).until(link_state=ONLINE)
        for reader, place in zip(self.readers, places):
            self.assertGreaterEqual(len(reader.samples("axis_event", place, axis=2)), 1)
            until("lost and found again", lambda reader=reader, place=place: len(
                [event for event in reader.samples("axis_event", place, axis=2) if event["kind"] in (LINK, BOOT)]) >= 2)
        self.assert_numbers_rise()

    def test_a_lease_that_runs_out_is_told(self):
        owner = self.peer()
        self.set_running(Axis(owner, 1))
        owner.reset()
        for reader in self.readers:
            reader.sample("axis_event", lambda event: "has run out" in event["text"], axis=1, kind=LEASE)
        self.watched(1).until(owner=NOBODY)


class Late(Events):
    def test_a_late_joiner_gets_the_newest_sixteen_of_an_axis(self):
        heard = self.readers[0]
        for i in range(KEPT):  # a lease taken, a set-point and a lease given back is more than one event
            axis = Axis(self.peer(), 1)
            axis.set(target_velocity=1000 * (i + 1))
            # What it does not take in time is not kept for it: it has the newest sixteen as well.
            heard.sample("axis_event", lambda event, told=f": target_velocity {1000 * (i + 1)} ": told in event["text"], axis=1)
            axis.command("release")
            axis.client.close()
        until("more events than are kept", lambda: len(heard.samples("axis_event", axis=1)) > KEPT + 3)
        for vendor in self.each_vendor():
            late = self.peer_of(vendor).read("axis_event")
            until("the newest sixteen, and they alone",
                  lambda late=late: late.samples("axis_event", axis=1) == heard.samples("axis_event", axis=1)[-KEPT:])


if __name__ == "__main__":
    main()
