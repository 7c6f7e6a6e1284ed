# SPDX-License-Identifier: Apache-2.0
"""The program that the manual prints, run as it stands there: its images at %IW and %QW, its switch and its two buttons."""
import time

from plc_stage import PLC, PlcStory, Scanner, StMachine, Unplugged, main, text_of

PLACES = (10.0, 25.0, -5.0)  # mm
COUNTS_PER_MM = 2000  # of the drive's encoder
TRIP = "2601 0x0020"


class Controller:
    """Runs `Table` of deploy/plc/example.st for axis 1 as a PLC does: inputs, program, outputs."""

    stations = {}

    def __init__(self, story, cycle_ms):
        self.scanner, self.cycle = Scanner(story.ports[0], PLC), cycle_ms / 1000
        self.machine = StMachine(text_of("deploy/plc/axisgate.st"), text_of("deploy/plc/example.st"))
        self.program = self.machine.new("Table")
        self.program.Axis1.AckTimeout = 60000
        self.places = self.machine.places("Table")
        story.plcs.append(self)
        story.addCleanup(self.scanner.close)

    def image(self, place):
        return getattr(self.program, self.places[place])

    def step(self):
        time.sleep(self.cycle)
        connected = self.scanner.connect()
        try:
            if connected:
                self.scanner.write(140, self.image("%QW0"))
                for place, first, count in (("%IW0", 100, 39), ("%IW39", 178, 18)):
                    self.image(place)[:] = self.scanner.read(first, count) or self.image(place)
        except Unplugged:
            self.scanner.close()
            connected = False
        self.program.ScannerOk = connected
        self.machine.now = int(time.monotonic() * 1000)
        self.program.run()


class Example(PlcStory):
    lines_of = ("serial",)
    axis_options = {"units_per_rev": 5000, "homing_method": 35}

    def test_three_positions_a_stop_and_a_reset(self):
        self.begin()
        table = Controller(self, 10).program
        table.SwitchedOn = True
        self.until_round(table)
        table.StopButton = True
        self.until("the stop is done", lambda: table.Stop1.Done)
        self.until_motor_stands(1)
        self.assert_stays(1, cycles=20)
        self.assertTrue(table.Status1.Stopping)
        table.StopButton = False
        self.until_round(table)
        self.sim.ask(f"fault serial/1 {TRIP}")
        self.until("the fault is told", lambda: table.Status1.ErrorStop)
        self.until_motor_stands(1)
        self.sim.ask(f"clear serial/1 {TRIP}")
        self.assert_stays(1, cycles=20)
        self.assertFalse(table.Power1.Status, "nothing goes on by itself")
        table.ResetButton = True
        self.until("the reset is done", lambda: table.Reset1.Done)
        table.ResetButton = False
        self.until_round(table)
        table.SwitchedOn = False
        self.until("it is disabled", lambda: table.Status1.Disabled)
        self.until_motor_stands(1)

    def until_round(self, table):
        """Each position is reached, one after the other."""
        for place, position in enumerate(PLACES, 1):
            self.until(f"it is on its way to place {place}", lambda place=place: table.Place == place and table.Move1.Busy)
            self.until(f"place {place} is reached", lambda: table.Move1.Done)
            # The program stands still meanwhile, and so does the motor.
            self.assertAlmostEqual(self.position(1) / COUNTS_PER_MM, position, delta=0.05)


if __name__ == "__main__":
    main()
