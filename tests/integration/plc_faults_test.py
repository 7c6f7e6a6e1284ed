# SPDX-License-Identifier: Apache-2.0
"""What a program sees of drives that trip, of cables between gateway and drive, and of values that are refused."""
from modbus import BAD_VALUE
from plc_stage import TURN, PlcStory, main

FAR = 5000.0 * TURN
SPEED = 5.0 * TURN
REFUSED_BY_DRIVE, NOT_REACHED = 3, 11
OVERSPEED = 100.0 * TURN
# What the drives' makers call an overcurrent, or what else ends all motion, as the simulator takes it.
TRIPS = {"mdserial": "2601 0x0020", "stepper": "14", "keyacanopen": "0x0040"}


class Trip(PlcStory):
    lines_of = tuple(TRIPS)

    def fault(self, word, number):
        line, motor = self.motors[number]
        self.sim.ask(" ".join([word, f"{line}/1", *([motor] if motor else []), TRIPS[line]]))

    def test_a_trip_is_an_error_until_its_cause_is_gone_and_it_is_reset(self):
        self.begin()
        # A Keya's overcurrent is cleared when both of its motors are disabled: its other one stays so.
        self.numbers.remove(self.number_of("keyacanopen", "B"))
        plc = self.plc()
        plc.enable()
        for number in self.numbers:
            plc.begin(number, "MoveVelocity", Velocity=SPEED)
        for number in self.numbers:
            self.until_motor_turns(number)
            self.until("it is active", lambda number=number: plc[number].MoveVelocity.Active)
            self.fault("fault", number)
        for number in self.numbers:
            station = plc[number]
            self.at = self.motors[number]
            self.until("it is told", lambda station=station: not station.MoveVelocity.Busy)
            self.assertEqual((station.MoveVelocity.Error, station.MoveVelocity.ErrorID), (True, 0x206))
            self.until("its cause, too", lambda station=station: station.ReadStatus.ErrorStop and station.ReadError.AxisErrorID)
            self.assertNotEqual(station.ReadError.AxisErrorID, 0xFFFF, "what is not known yet is no cause")
            self.assertEqual((station.Power.Status, station.Power.Error, station.Power.ErrorID), (False, True, 0x208))
            self.until_motor_stands(number)
            self.assertEqual(plc.end(number, "MoveVelocity"), "Error")
            run = plc.begin(number, "MoveVelocity", Velocity=SPEED)
            self.until("it is refused", lambda run=run: not run.Busy)
            self.assertEqual((run.Error, run.ErrorID), (True, 9), "no motion begins in ErrorStop")
            plc.end(number, "MoveVelocity")
            reset = plc.begin(number, "Reset")
            self.until("its end", lambda reset=reset: not reset.Busy)
            self.assertEqual((reset.Error, reset.ErrorID in (REFUSED_BY_DRIVE, NOT_REACHED)), (True, True), "its cause is there still")
            plc.end(number, "Reset")
            self.assertFalse(station.Power.Status)
            self.fault("clear", number)
            plc.do(number, "Reset")
            self.until("enabled as before", lambda station=station: station.Power.Status and not station.Power.Error)
            self.until("nothing is told any more", lambda station=station: station.ReadError.AxisErrorID == 0)
            self.until("standstill", lambda station=station: station.ReadStatus.Standstill)
            self.assert_stays(number)  # nothing resumes
            plc.begin(number, "MoveVelocity", Velocity=-SPEED)
            plc.until_at_speed(number)
        self.at = None


class DriveCable(PlcStory):
    """Between gateway and drive: the PLC's connection goes on."""

    # Those that do not trip when they hear nobody: a drive with a fault stands, and a stop of it is over.
    lines_of = ("modbus", "leadshine")
    reply_timeout_ms = 300

    def test_what_runs_is_an_error_and_a_stop_is_kept_until_the_drive_is_back(self):
        self.begin()
        plc = self.plc()
        plc.enable()
        for number in self.numbers:
            plc.begin(number, "MoveVelocity", Velocity=SPEED)
            self.until("it is active", lambda number=number: plc[number].MoveVelocity.Active)
            self.sim.ask(f"unplug {self.motors[number][0]}")
        for number in self.numbers:
            station = plc[number]
            self.until("it is told", lambda station=station: not station.MoveVelocity.Busy)
            self.assertEqual((station.MoveVelocity.Error, station.MoveVelocity.ErrorID), (True, 0x206))
            self.assertEqual((station.ReadStatus.Valid, station.ReadStatus.ErrorID), (False, 0x209))
            self.assertEqual((station.Power.Status, station.Power.ErrorID), (False, 0x208))
            plc.end(number, "MoveVelocity")
            plc.begin(number, "Stop")
        self.cycles(20)
        for number in self.numbers:
            self.assertTrue(plc[number].Stop.Busy, "nobody knows whether the motor stands")
            self.sim.ask(f"plug {self.motors[number][0]}")
        for number in self.numbers:
            self.at = self.motors[number]
            self.until("it has stopped", lambda number=number: plc[number].Stop.Done)
            self.until_motor_stands(number)
            plc.end(number, "Stop")
            self.until("the drive is back", lambda number=number: plc[number].ReadStatus.Valid and plc[number].Axis.LinkState == 2)
            plc.do(number, "Reset")
            self.until("it is enabled", lambda number=number: plc[number].Power.Status and not plc[number].Power.Error)
            plc.begin(number, "MoveVelocity", Velocity=-SPEED)
            plc.until_at_speed(number)
        self.at = None


class Values(PlcStory):
    lines_of = ("serial", "stepper")
    axis_options = {"limits": {"position": [-10 * TURN, 10 * TURN], "velocity": 3000000}}

    def setUp(self):
        super().setUp()
        self.begin()
        self.day = self.plc()
        self.day.enable()

    def assert_refused(self, number, block, error, **inputs):
        made = self.day.begin(number, block, **inputs)
        self.until("its end", lambda: not made.Busy)
        self.assertEqual((made.Error, hex(made.ErrorID)), (True, hex(error)), inputs)
        self.day.end(number, block)
        self.assert_stays(number)

    def test_what_is_refused_is_an_error_and_the_next_move_is_done(self):
        for number in self.numbers:
            self.at = self.motors[number]
            for inputs, error in (({"Position": 11.0 * TURN}, 0x12A), ({"Position": 1.0 * TURN, "Velocity": OVERSPEED}, 0x130),
                                  ({"Position": 1.0 * TURN, "Velocity": -SPEED}, 0x203), ({"Position": 1e12}, 0x203),
                                  ({"Position": 1.0 * TURN, "Velocity": 1e-6}, 0x203)):
                self.assert_refused(number, "MoveAbsolute", error, **{"Velocity": 0.0, **inputs})
                self.day.do(number, "MoveAbsolute", Position=1.0 * TURN, Velocity=SPEED)
                self.until("it is there", lambda number=number: abs(self.day[number].Axis.Position - TURN) <= 20)
                self.until_motor_stands(number)
            refused = len(self.day.scanner.refused)
            self.cycles(10)
            self.assertEqual(len(self.day.scanner.refused), refused, "what was refused is not said again and again")
        self.at = None

    def test_the_same_mistake_twice_is_told_twice(self):
        number = self.number_of("serial")
        self.day[number].Axis.AckTimeout = 3000
        for _ in range(2):
            made = self.day.begin(number, "MoveAbsolute", Position=1.0 * TURN, Velocity=OVERSPEED)
            self.until("its end", lambda made=made: not made.Busy)
            self.assertIn(made.ErrorID, (0x130, 0x202), "the registers read the same before and after")
            self.assertEqual(self.day.end(number, "MoveAbsolute"), "Error")
        self.day[number].Axis.AckTimeout = 60000
        self.assertIn(BAD_VALUE, self.day.scanner.refused)
        self.day.do(number, "MoveAbsolute", Position=2.0 * TURN, Velocity=SPEED)

    def test_a_relative_move_is_never_added_to_one_under_way(self):
        for number in self.numbers:
            self.day.begin(number, "MoveAbsolute", Position=9.0 * TURN, Velocity=SPEED / 5)
            self.until("it is active", lambda number=number: self.day[number].MoveAbsolute.Active)
            self.until_motor_turns(number)
            relative = self.day.begin(number, "MoveRelative", Distance=1.0 * TURN)
            self.until("its end", lambda relative=relative: not relative.Busy)
            self.assertTrue(relative.Error)
            self.assertTrue(self.day[number].MoveAbsolute.Active, "the other goes on")
            self.day.end(number, "MoveRelative")
            self.day.do(number, "Stop")
            self.until_motor_stands(number)


class Units(PlcStory):
    """Millimetres, of a table that moves 5 mm a turn, with 0.001 mm as the gateway's unit; and the other word order."""

    lines_of = ("serial", "stepper")
    axis_options = {"units_per_rev": 5000}
    listener_options = {"writes": "posted", "client": "address", "word_order": "low-first"}

    def test_positions_and_velocities_are_the_programs(self):
        self.begin()
        plc = self.plc()
        for station in plc.stations.values():
            station.Axis.UnitScale, station.Axis.LowWordFirst = 1000.0, True
        plc.enable()
        for number in self.numbers:
            start = self.position(number)
            plc.do(number, "MoveAbsolute", Position=-12.5, Velocity=25.0)
            self.until("it is there", lambda number=number: abs(plc[number].Axis.Position + 12.5) < 0.02)
            self.until_motor_stands(number)
            self.assertAlmostEqual((self.position(number) - start) / TURN, -2.5, delta=0.01, msg="turns of the motor")
            plc.begin(number, "MoveVelocity", Velocity=20.0)  # 240 rpm
            plc.until_at_speed(number)
            self.assertAlmostEqual(plc[number].Axis.Velocity, 20.0, delta=1.0)
            self.assertAlmostEqual(self.watched_rpm(number), 240, delta=12)

    def watched_rpm(self, number):
        low, high = self.watcher.registers(100 * number + 4, 2)
        return (high << 16 | low) / 1000


if __name__ == "__main__":
    main()
