# SPDX-License-Identifier: Apache-2.0
"""A PLC's normal day with the shipped function blocks, each block on drives that differ most: it enables, moves, runs, jogs, homes, stops,
disables. Each kind of drive: plc_scan_test.py."""
from plc_stage import TURN, PlcStory, main

FAR = 5000.0 * TURN
SPEED = 5.0 * TURN  # units per second
RPM = 300  # which is this
RAMP = 50.0 * TURN
CENTRE = 20  # units that a drive may stand beside its target
HERE = 35  # homing method: where it stands
HOMES = ("leadshine", "kincocan", "modbus")


class Day(PlcStory):
    def setUp(self):
        super().setUp()
        self.begin()
        self.day = self.plc()
        self.day.enable()

    def buses(self):
        buses = super().buses()
        for line in buses:
            if line["name"] in HOMES:
                line["drives"][0]["axes"][0]["homing_method"] = HERE
        return buses

    def velocity(self, number):
        """0: the drive's own."""
        return 0.0 if self.motors[number][0] == "keyaplaces" else SPEED

    def ramps(self, number):
        """A Keya has none that a bus writes."""
        return {} if self.motors[number][1] else {"Acceleration": RAMP, "Deceleration": RAMP}

    def begin_all(self, position):
        for number in self.numbers:
            self.day.begin(number, "MoveAbsolute", Position=position, Velocity=self.velocity(number), **self.ramps(number))

    def run_all(self, velocity=SPEED):
        for number in self.numbers:
            self.day.begin(number, "MoveVelocity", Velocity=velocity, **self.ramps(number))
        for number in self.numbers:
            self.day.until_at_speed(number)
            self.assertTrue(self.day[number].ReadStatus.ContinuousMotion)

    def end_all(self, block, how, numbers=None):
        numbers = numbers or self.numbers
        self.assertEqual({number: self.day.end(number, block) for number in numbers}, dict.fromkeys(numbers, how))

    def until_all_there(self, position):
        for number in self.numbers:
            self.until_there(number, position)

    def until_there(self, number, position):
        axis = self.day[number].Axis
        self.until(f"axis {number} is at {position}", lambda: abs(axis.Position - position) <= CENTRE)
        self.until_motor_stands(number)


class Positioning(Day):
    lines_of = ("leadshine", "stepper", "keyaplaces")

    def test_moves_arrive_where_they_were_asked_to(self):
        start = {number: self.turns(number) for number in self.numbers}
        for turns in (2.0, -1.0, 3.0):
            self.begin_all(turns * TURN)
            self.end_all("MoveAbsolute", "Done")
            for number in start:
                self.until_there(number, turns * TURN)
                self.assertAlmostEqual(self.turns(number) - start[number], turns, delta=0.01, msg=f"the motor itself, {self.motors[number]}")
        for number in start:
            self.day.begin(number, "MoveRelative", Distance=-1.0 * TURN)
        self.end_all("MoveRelative", "Done")
        for number in start:
            self.until_there(number, 2.0 * TURN)
            self.assertAlmostEqual(self.turns(number) - start[number], 2.0, delta=0.01)

    def test_the_end_of_a_move_is_told_for_one_cycle_where_execute_was_short(self):
        told = dict.fromkeys(self.numbers, 0)
        for number in told:
            move = self.day[number].MoveAbsolute
            move.Position, move.Velocity, move.Execute = 1.0 * TURN, self.velocity(number), True
        self.go_on()
        for number in told:
            self.day[number].MoveAbsolute.Execute = False

        def count():
            for number in told:
                told[number] += self.day[number].MoveAbsolute.Done
            return all(told.values())

        self.until("each has told it", count)
        for _ in range(3):
            self.go_on()
            count()
        self.assertEqual(set(told.values()), {1})

    def test_homing_and_set_position_end_where_the_axis_stands(self):
        homing, stepper = self.number_of("leadshine"), self.number_of("stepper")
        self.day.do(homing, "MoveAbsolute", Position=1.0 * TURN, Velocity=SPEED)
        self.until_motor_stands(homing)
        self.day.do(homing, "Home")
        self.until_there(homing, 0.0)
        self.assertEqual(self.position(homing), 0, "the drive's own zero")
        for place in (12345.0, -7.0):
            self.day.do(stepper, "SetPosition", Position=place)
            self.until_there(stepper, place)
        for motor in ("A", "B"):
            set_position = self.day.begin(self.number_of("keyaplaces", motor), "SetPosition", Position=1.0)
            self.assertEqual((set_position.Error, set_position.ErrorID), (True, 0x20A), "no bus command sets this drive's count")


class Interrupting(Day):
    lines_of = ("kincocan", "modbus", "keyaplaces")

    def test_a_newer_move_takes_the_place_of_one_under_way(self):
        self.begin_all(FAR)
        for number in self.numbers:
            self.until("the first is active", lambda number=number: self.day[number].MoveAbsolute.Active)
            self.day.begin(number, "MoveOther", Position=-1.0 * TURN)
        self.end_all("MoveAbsolute", "CommandAborted")
        self.end_all("MoveOther", "Done")
        self.until_all_there(-1.0 * TURN)

    def test_a_move_is_stopped_and_another_goes_on_from_there(self):
        """On every drive alike, also where it can only halt by a quick stop that takes its torque."""
        for block in ("Stop", "Halt"):
            self.begin_all(FAR)
            for number in self.numbers:
                self.until("it is active", lambda number=number: self.day[number].MoveAbsolute.Active)
                self.until_motor_turns(number)
                self.day.begin(number, block)
            self.end_all("MoveAbsolute", "CommandAborted")
            self.end_all(block, "Done")
            for number in self.numbers:
                self.assertFalse(self.day[number].Power.Error)
                place = self.day[number].Axis.Position + TURN
                self.day.do(number, "MoveAbsolute", Position=place, Velocity=self.velocity(number))
                self.until_there(number, place)

    def test_of_two_moves_that_wait_or_come_in_one_cycle_the_newer_one_is_carried_out(self):
        """Whatever the order in which the program calls them: MoveAbsolute comes first."""
        for waits in (True, False):
            older, newer = ("MoveOther", "MoveAbsolute") if waits else ("MoveAbsolute", "MoveOther")
            for number in self.numbers:
                station = self.day[number]
                for block, turns in ((older, 3.0), (newer, 1.0)):
                    made = getattr(station, block)
                    made.Position, made.Velocity = turns * TURN, self.velocity(number)
                station.Reset.Execute = waits
                getattr(station, older).Execute = True
                getattr(station, newer).Execute = not waits
            self.go_on()
            if waits:
                for number in self.numbers:
                    self.assertTrue(self.day[number].MoveOther.Busy and not self.day[number].MoveOther.Active)
                    self.day[number].MoveAbsolute.Execute = True
                self.go_on()
            self.end_all(newer, "Done")
            self.end_all(older, "CommandAborted")
            self.until_all_there(1.0 * TURN)
            for number in self.numbers:
                self.day.do(number, "MoveAbsolute", Position=0.0, Velocity=self.velocity(number))


class Running(Day):
    lines_of = ("mdcan", "keya485")

    def test_it_runs_at_the_velocity_asked_for_and_halts(self):
        self.run_all()
        for number in self.numbers:
            self.assert_turns_on(number)
            self.until(f"the motor of axis {number} itself turns at {RPM} rpm", lambda number=number: abs(self.rpm(number) - RPM) <= RPM / 50)
            self.day.begin(number, "Halt")
        self.end_all("MoveVelocity", "CommandAborted")
        self.end_all("Halt", "Done")
        self.until_motor_stands(*self.numbers)
        for number in self.numbers:
            self.assertTrue(self.day[number].Power.Status, "a halt keeps the torque")
            self.assertTrue(self.day[number].ReadStatus.Standstill)

    def test_a_run_with_another_velocity_replaces_it(self):
        turned = {}
        for velocity in (SPEED, -SPEED):
            self.run_all(velocity)
            for number in self.numbers:
                before = self.position(number)
                self.assert_turns_on(number)
                turned.setdefault(number, []).append(self.position(number) > before)
        for number, ways in turned.items():
            self.assertNotEqual(*ways, f"axis {number} turns the other way")

    def test_nothing_begins_while_a_stop_is_held(self):
        self.run_all()
        for number in self.numbers:
            self.day.begin(number, "Stop", **({} if self.motors[number][1] else {"Deceleration": RAMP}))
        self.end_all("MoveVelocity", "CommandAborted")
        for number in self.numbers:
            self.until("it has stopped", lambda number=number: self.day[number].Stop.Done)
        self.until_motor_stands(*self.numbers)
        for number in self.numbers:
            self.assertTrue(self.day[number].ReadStatus.Stopping)
            run = self.day.begin(number, "MoveVelocity", Velocity=SPEED)
            self.assertEqual((run.Error, run.ErrorID), (True, 0x204))
        self.assert_stays(*self.numbers)
        for number in self.numbers:
            self.day.end(number, "MoveVelocity")
            self.day.end(number, "Stop")
            self.until("standstill", lambda number=number: self.day[number].ReadStatus.Standstill)
        self.run_all()

    def test_what_is_switched_off_in_the_cycle_of_a_stop_stops_and_has_no_torque(self):
        self.run_all()
        for number in self.numbers:
            self.day[number].Stop.Execute, self.day[number].Power.Enable = True, False
        self.go_on()
        self.until("all are disabled", lambda: all(self.day[number].ReadStatus.Disabled for number in self.numbers))
        self.end_all("Stop", "Done")
        self.until_motor_stands(*self.numbers)
        self.day.enable()
        self.run_all()

    def until_jogging(self, number, sign):
        station = self.day[number]
        self.day.until_or_over(f"axis {number} jogs", lambda: abs(station.Axis.Velocity - sign * SPEED) < SPEED / 10,
                               lambda: station.Jog.Error or station.Jog.CommandAborted)

    def until_jogged(self):
        self.until("all have ended", lambda: not any(self.day[number].Jog.Busy for number in self.numbers))
        self.assertTrue(all(self.day[number].Jog.Done for number in self.numbers))

    def test_jog_runs_as_long_as_it_is_held(self):
        for way, sign in (("JogForward", 1), ("JogBackward", -1)):
            for number in self.numbers:
                jog = self.day[number].Jog
                jog.Velocity = SPEED
                setattr(jog, way, True)
            for number in self.numbers:
                self.until_jogging(number, sign)
                self.assertTrue(self.day[number].Jog.Active)
                setattr(self.day[number].Jog, way, False)
            self.until_jogged()
            self.until_motor_stands(*self.numbers)

    def test_jog_turns_round_and_both_at_once_halt(self):
        for number in self.numbers:
            self.day[number].Jog.Velocity = SPEED
            self.day[number].Jog.JogForward = True
        for number in self.numbers:
            self.until_jogging(number, 1)
            self.day[number].Jog.JogForward, self.day[number].Jog.JogBackward = False, True
        for number in self.numbers:
            self.until_jogging(number, -1)
            self.day[number].Jog.JogForward = True
        self.until_jogged()
        self.until_motor_stands(*self.numbers)

    def test_disabling_ends_what_runs(self):
        self.run_all()
        self.day.disable()
        self.end_all("MoveVelocity", "CommandAborted")
        self.until_motor_stands(*self.numbers)
        for number in self.numbers:
            run = self.day.begin(number, "MoveVelocity", Velocity=SPEED)
            self.until("it is refused", lambda run=run: not run.Busy)
            self.assertEqual((run.Error, run.ErrorID), (True, 9), "an axis that is disabled is in no state for it")
        self.assert_stays(*self.numbers)


if __name__ == "__main__":
    main()
