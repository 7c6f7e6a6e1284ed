# SPDX-License-Identifier: Apache-2.0
"""Drives of three makers' types on one Modbus RTU line: each moves, one is in trouble and its neighbours go on, the cable is pulled."""
import cable_test
from cable_test import NEVER_SENT, OUTCOME_UNKNOWN, Cable
from drive_faults_test import FAR, RPM, TIMEOUT, Line
from modbus import ALARM_ADOPTED, DISABLED, FAILED, NO_ANSWER, NO_PATH, ONLINE, STANDSTILL
from processes import until
from stage import bus, drive, main


class ThreeMakers(Line):
    """JD, iD286pro and MD; the stepper in their middle has the fault."""

    adapter = "modbus-rtu"
    line = "axes"
    lines = {"axes": "rtu:jd@1,id286pro@2,md@3"}
    kinds = ("jd", "id286pro", "md")

    def drives(self):
        return [drive(kind, number, number) for number, kind in enumerate(self.kinds, 1)]

    def broken_frames(self, bus_now):
        return bus_now["dropped_bytes"] + bus_now["bad_frames"] + bus_now["late_replies"] + bus_now["timeouts"]


class Neighbours(ThreeMakers):
    def test_each_moves(self):
        for axis in self.axes:
            self.move(axis)
        positions = [int(self.sim.ask(f"position {self.line}/{number}")) for number in (1, 2, 3)]
        for position, pulses in zip(positions, (10000, 10000, 65536)):
            self.assertAlmostEqual(position, pulses, delta=100)
        for axis in self.axes:
            axis.command("disable")
            axis.until(axis_state=DISABLED)
        counts = self.client.bus(0)
        # A busy machine's answer may be late: then it has come all the same.
        self.assertEqual((counts["timeouts"] - counts["late_replies"], counts["bad_frames"]), (0, 0))

    def test_one_is_mute(self):
        self.be_unresponsive_for_a_while()
        self.move(self.middle)

    def test_one_is_late(self):
        self.tell_late(TIMEOUT + 100)

    def test_one_babbles(self):
        self.stand_somewhere()
        self.watch_until("babble DRIVE 0.1", lambda bus_now: self.broken_frames(bus_now) >= 50)
        self.healed()
        for axis in self.axes:
            axis.until(link_state=ONLINE)
        self.assert_others_go_on()
        self.move(self.middle)

    def test_frames_that_break_off_have_a_wrong_length_or_stick_together(self):
        self.stand_somewhere()
        for what in ("half", "wrong-length", "glued", "corrupt", "wrong-station"):
            before = self.broken_frames(self.client.bus(0))
            self.watch_until(f"{what} DRIVE 0.3", lambda bus_now: self.broken_frames(bus_now) >= before + 4)
            self.healed()
        self.assert_others_go_on()
        self.move(self.middle)


class UnresponsiveKinco(ThreeMakers):
    """The JD in the middle of two iD286pro and an MD's line."""

    lines = {"axes": "rtu:id286pro@1,jd@2,md@3"}
    kinds = ("id286pro", "jd", "md")

    def test_one_is_mute(self):
        self.tell_mute()

    def test_what_a_kinco_refuses_comes_with_its_exception(self):
        self.middle.set(object_index=0x3201, object_subindex=0, object_size=2)
        self.middle.set(object_request=1)
        block = until("refused", lambda: (block := self.middle.block()) if self.middle.get("object_status") == 3 else None)
        self.assertNotEqual(block["object_detail"], 0)
        self.assertEqual(block["link_state"], ONLINE)


class PulledStepper(Cable):
    """Somebody pulls the cable of the iD286pro; an MD hangs on another line."""

    lines = {"lift": "rtu:id286pro@1", "feeder": "md@1"}
    extra = {}

    def buses(self):
        return [bus(self.path("lift"), drive("id286pro", 1, 1), adapter="modbus-rtu", **self.extra),
                bus(self.path("feeder"), drive("md", 1, 2))]

    def commands(self):
        return int(self.sim.ask("writes lift/1 323"))


class PulledWhile(PulledStepper):
    def setUp(self):
        super().setUp()
        self.begin()

    def pull_and_put_back(self):
        written = self.commands()
        self.pull()
        self.assert_gone(self.lift)
        self.assert_unaffected(self.feeder)
        self.put_back()
        self.assert_back(self.lift)
        self.assertEqual(self.commands(), written, "nothing was started or stopped")

    def test_idle(self):
        self.pull_and_put_back()
        self.assertEqual(self.lift.get("axis_state"), DISABLED)
        self.lift.command("enable")
        self.lift.until(axis_state=STANDSTILL)

    def test_moving(self):
        self.lift.set(profile_velocity=600 * RPM, target_position=FAR)
        self.lift.command("enable")
        number = self.lift.command("move_absolute")
        self.lift.until_input("moving")
        self.pull_and_put_back()
        self.assertEqual(self.lift.until(motion_state=FAILED)["motion_id"], number, "a lost link ends every motion for good")
        self.assertEqual(self.sim.state("lift/1"), "running", "nobody could tell it")
        self.assertTrue(self.lift.get("axis_alarms") & ALARM_ADOPTED)
        self.lift.command("disable")
        self.lift.until(axis_state=DISABLED)
        until("it stands", lambda: self.sim.state("lift/1") == "stopped")
        until("no longer adopted", lambda: not self.lift.get("axis_alarms") & ALARM_ADOPTED)


class PulledOnAQuietLine(PulledStepper):
    """Nothing is polled, so what is on the wire is known."""

    extra = {"timeout_ms": 10000, "poll": {"fast": 60000, "normal": 60000, "slow": 600000}}

    def setUp(self):
        super().setUp()
        self.begin(listeners=[self.listener(start_deadline_ms=60000, reply_deadline_ms=60000)])
        self.first, self.second = self.connect().axis(1), self.connect().axis(1)

    def test_while_an_answer_is_waited_for_and_a_command_waits_behind_it(self):
        self.sim.ask("late lift/1 5000 next 1")
        write = self.later(lambda: self.first.set(profile_acceleration=120000))
        until("the write at the drive", lambda: self.sim.ask("writes lift/1 303") == "1")
        command = self.later(lambda: self.second.command("enable"))
        until("the command waits", lambda: self.client.bus(0)["queue_depth"] >= 1)
        self.pull()
        self.assertEqual((self.code_of(write), self.code_of(command)), (NO_ANSWER, NO_PATH))
        self.assertEqual((self.first.get("command_result"), self.second.get("command_result")), (OUTCOME_UNKNOWN, NEVER_SENT))
        self.put_back()
        self.assertEqual(self.sim.ask("writes lift/1 303"), "1", "it is not written twice")
        self.assertEqual((self.lift.get("profile_acceleration"), self.lift.get("axis_state")), (120000, DISABLED))


class PulledAtStart(PulledStepper, cable_test.PulledAtStart):
    def test_during_setup(self):  # a class is run where it has a test of its own; the others are inherited
        super().test_during_setup()


if __name__ == "__main__":
    main()
