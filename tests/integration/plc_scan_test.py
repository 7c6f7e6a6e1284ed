# SPDX-License-Identifier: Apache-2.0
"""Many axes on one connection, and controllers of every speed: cycles of 4, 20 and 200 ms, a listener that answers when the drive has
acknowledged."""
import sys

from plc_stage import AT_SPEED_ALONE, EVERY_KIND, TO_POSITIONS_ALONE, TURN, PlcStory, main

SPEED = 5.0 * TURN
RAMP = 50.0 * TURN
DRIVES = 10  # on each of two lines


class TwentyAxes(PlcStory):
    def setUp(self):
        super().setUp()
        self.simulate({"left": "lawicel:" + ",".join(f"ld2@{node}" for node in range(1, DRIVES + 1)),
                       "right": "rtu:" + ",".join(f"jd@{node}" for node in range(1, DRIVES + 1))})
        self.configure()
        self.run_gateway()
        self.client = self.peer("127.0.0.9")
        self.until_online()
        self.numbers = list(range(1, 2 * DRIVES + 1))

    def buses(self):
        def drives(profile, constants, first):
            return [{"profile": profile, "node": node, "constants": constants,
                     "axes": [{"axis": first + node, "name": f"{profile}-{node}", "lease": self.lease}]} for node in range(1, DRIVES + 1)]

        return [{"name": "left", "adapter": "canopen", "device": f"slcan:{self.path('left')}", "bitrate": 1000000, "timeout_ms": 1000,
                 "drives": drives("leadshine-ld2-can", {}, 0)},
                {"name": "right", "adapter": "modbus-rtu", "device": self.path("right"), "rs485": "off", "timeout_ms": 1000,
                 "drives": drives("kinco-jd", {"peak_current_a": 27.5}, DRIVES)}]

    def place(self, number):
        line, node = ("left", number) if number <= DRIVES else ("right", number - DRIVES)
        return int(self.sim.ask(f"position {line}/{node}"))

    def test_each_goes_where_it_was_sent(self):
        plc = self.plc(cycle_ms=50)
        plc.enable()
        start = {number: self.place(number) for number in self.numbers}
        for number in self.numbers:
            move = plc[number].MoveAbsolute
            move.Position, move.Velocity, move.Acceleration, move.Deceleration = number * TURN / 10, SPEED, RAMP, RAMP
            move.Execute = True
        self.go_on()
        self.until("all have ended", lambda: not any(plc[number].MoveAbsolute.Busy for number in self.numbers))
        for number in self.numbers:
            self.assertTrue(plc[number].MoveAbsolute.Done, plc.told(number))
            self.until("it is there", lambda number=number: abs(plc[number].Axis.Position - number * TURN / 10) <= 20)
        moved = {number: self.place(number) - start[number] for number in self.numbers}
        for first in (1, DRIVES + 1):
            for number in range(first, first + DRIVES):
                self.assertAlmostEqual(moved[number] / moved[first] * first, number, delta=0.1, msg="the motor itself")
        plc.disable()


class Cycles(PlcStory):
    lines_of = ("stepper", "leadshine")

    def short_day(self, cycle_ms, **more):
        self.begin()
        plc = self.plc(cycle_ms=cycle_ms, **more)
        plc.enable()
        for number in self.numbers:
            line = self.motors[number][0]
            if line not in AT_SPEED_ALONE:
                self.one_move(plc, number, cycle_ms)
            if line not in TO_POSITIONS_ALONE:
                self.one_run(plc, number, cycle_ms)
            plc.do(number, "Stop")
            self.until_motor_stands(number)
        plc.disable()

    def cycles_until(self, plc, block, events):
        """How many cycles after the rising edge of Execute, which comes now, each of these was first so: looked at once a cycle. What has
        ended in another way is not waited for."""
        begun, seen = plc.cycles, {}

        def look():
            for name, is_so in events.items():
                if name not in seen and is_so():
                    seen[name] = plc.cycles - begun
            return len(seen) == len(events) or block.Error or block.CommandAborted

        block.Execute = True
        self.go_on()
        self.until(f"all of {list(events)}", look)
        return seen

    def one_move(self, plc, number, cycle_ms):
        start = self.turns(number)
        move = plc[number].MoveAbsolute
        move.Position = 1.0 * TURN
        move.Velocity = 0.0 if self.motors[number][0] in TO_POSITIONS_ALONE else SPEED
        seen = self.cycles_until(plc, move, {
            "motion": lambda: self.turns(number) != start, "end": lambda: not move.Busy,
            "standstill": lambda: abs(self.turns(number) - start - 1.0) < 0.01 and self.speed(number) == 0})
        self.assertTrue(move.Done, plc.told(number))
        self.until_motor_stands(number)
        self.assertAlmostEqual(self.turns(number) - start, 1.0, delta=0.01, msg="the motor itself")
        print(f"figures: {self.motors[number][0]}, cycle {cycle_ms} ms: motion {seen['motion']} cycles after Execute, Done "
              f"{seen['end'] - seen['standstill']} cycles after the motor stood", file=sys.stderr)
        plc.end(number, "MoveAbsolute")

    def one_run(self, plc, number, cycle_ms):
        start = self.turns(number)
        run = plc[number].MoveVelocity
        run.Velocity = -SPEED
        seen = self.cycles_until(plc, run, {"motion": lambda: self.turns(number) != start, "speed": lambda: run.InVelocity or not run.Busy})
        self.assertTrue(run.InVelocity, plc.told(number))
        print(f"figures: {self.motors[number][0]}, cycle {cycle_ms} ms: motion {seen['motion']} cycles after Execute of a run",
              file=sys.stderr)
        run.Execute = False


class EveryKind(Cycles):
    """Its figures are those of docs/plc.md."""

    lines_of = EVERY_KIND

    def test_a_cycle_of_20_ms(self):
        self.short_day(20)


class OtherCycles(Cycles):
    """Neither program nor scanner waits for the other."""

    def test_a_cycle_of_4_ms(self):
        self.short_day(4)

    def test_a_cycle_of_200_ms(self):
        self.short_day(200)

    def test_the_scanner_exchanges_in_every_third_cycle(self):
        self.short_day(10, every=3)

    def test_the_scanner_exchanges_twice_in_a_cycle(self):
        self.short_day(20, scans=2)


class WritesThatWait(Cycles):
    """As the listener has it by default: the scanner's write is answered when the drive has acknowledged it."""

    listener_options = {"client": "address"}

    def test_a_cycle_of_20_ms(self):
        self.short_day(20)


if __name__ == "__main__":
    main()
