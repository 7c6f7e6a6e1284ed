# SPDX-License-Identifier: Apache-2.0
"""The programs that the manual prints, with blocks and without, run as they stand there: images at %IW and %QW, a switch and two buttons."""
import time

from modbus import ONLINE
from plc_stage import PLC, PlcStory, Scanner, StMachine, Unplugged, main, text_of

PLACES = (10.0, 25.0, -5.0)  # mm
COUNTS_PER_MM = 2000  # of the drive's encoder
TRIP = "2601 0x0020"


class Controller:
    """Runs a program for axis 1 as a PLC does: inputs, program, outputs."""

    stations = {}

    def __init__(self, story, cycle_ms, name, *texts):
        self.scanner, self.cycle = Scanner(story.ports[0], PLC), cycle_ms / 1000
        self.machine = StMachine(*map(text_of, texts))
        self.program = self.machine.new(name)
        self.places = self.machine.places(name)
        self.reads = [(place, first, count) for place, first, count in (("%IW0", 100, 39), ("%IW39", 178, 18)) if place in self.places]
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
                for place, first, count in self.reads:
                    self.image(place)[:] = self.scanner.read(first, count) or self.image(place)
        except Unplugged:
            self.scanner.close()
            connected = False
        self.program.ScannerOk = connected
        self.machine.now = int(time.monotonic() * 1000)
        self.program.run()


class OfOneTable(PlcStory):
    lines_of = ("serial",)
    axis_options = {"units_per_rev": 5000, "homing_method": 35}

    def assert_at(self, position):
        self.assertAlmostEqual(self.position(1) / COUNTS_PER_MM, position, delta=0.05)

    def trip(self, fault=True):
        self.sim.ask(f"{'fault' if fault else 'clear'} serial/1 {TRIP}")


class Example(OfOneTable):
    def test_three_positions_a_stop_and_a_reset(self):
        self.begin()
        table = Controller(self, 10, "Table", "deploy/plc/axisgate.st", "deploy/plc/example.st").program
        table.Axis1.AckTimeout = 60000
        table.SwitchedOn = True
        self.until_round(table)
        table.StopButton = True
        self.until("the stop is done", lambda: table.Stop1.Done)
        self.until_motor_stands(1)
        self.assert_stays(1, cycles=20)
        self.assertTrue(table.Status1.Stopping)
        table.StopButton = False
        self.until_round(table)
        self.trip()
        self.until("the fault is told", lambda: table.Status1.ErrorStop)
        self.until_motor_stands(1)
        self.trip(False)
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
            self.assert_at(position)


class WithoutBlocks(OfOneTable):
    OFF, MOVE, WAITS = 0, 3, 9

    def setUp(self):
        super().setUp()
        self.begin()
        self.plc = Controller(self, 10, "Plain", "deploy/plc/example_plain.st")
        self.table = self.plc.program
        self.table.AckTimeout = 60000

    def until_round(self):
        for place, position in enumerate(PLACES, 1):
            self.until(f"it is on its way to place {place}", lambda place=place: (self.table.Stage, self.table.Place) == (self.MOVE, place))
            self.until(f"place {place} is reached", lambda place=place: self.table.Place != place)
            self.assert_at(position)  # the next command is still in the image

    def until_switched_off(self):
        self.table.SwitchedOn = False
        self.until("it is disabled", lambda: self.watched(1).get("axis_state") == 0)
        self.until_motor_stands(1)

    def test_three_positions_a_stop_and_a_reset(self):
        table = self.table
        table.SwitchedOn = True
        self.until_round()
        table.StopButton = True
        self.until("the stop is latched", lambda: "stop_latched" in self.watched(1).inputs())
        self.until_motor_stands(1)
        self.assert_stays(1, cycles=20)
        table.StopButton = False
        self.until_round()
        self.trip()
        self.until("it waits for the reset", lambda: table.Stage == self.WAITS)
        self.until_motor_stands(1)
        self.trip(False)
        self.assert_stays(1, cycles=20)
        table.ResetButton = True
        self.until_round()
        table.ResetButton = False
        self.until_switched_off()

    def test_a_lost_connection_starts_nothing_when_it_is_back(self):
        table = self.table
        table.SwitchedOn = True
        self.until_round()
        self.until_motor_turns(1)
        self.plc.scanner.plugged = False
        self.plc.scanner.close()
        self.until("it waits for the reset", lambda: table.Stage == self.WAITS)
        self.cycles(5)
        self.plc.scanner.plugged = True
        self.until("the ids are agreed on", lambda: table.Phase == 2)
        # What was under way ends there: no lease has run out in this story.
        self.until_motor_stands(1)
        self.assert_stays(1, cycles=20)
        table.ResetButton = True
        self.until_round()
        self.until_switched_off()

    def test_a_drive_out_of_sight_starts_nothing_when_it_is_back(self):
        table = self.table
        table.SwitchedOn = True
        self.until_round()
        self.until_motor_turns(1)
        self.sim.ask("unplug serial")
        self.until("it waits for the reset", lambda: table.Stage == self.WAITS)
        self.sim.ask("plug serial")
        self.until("the drive is back", lambda: self.watched(1).get("link_state") == ONLINE)
        self.until_motor_stands(1)
        self.assert_stays(1, cycles=20)
        table.ResetButton = True
        self.until_round()
        self.until_switched_off()

    def test_its_stop_button_stops_what_another_client_moves_and_nothing_follows(self):
        panel = self.peer("127.0.0.2").axis(1)
        panel.set(profile_velocity=300000, target_position=50000000)
        panel.command("enable")
        panel.command("move_absolute")
        self.until_motor_turns(1)
        self.cycles(20)
        self.assert_turns_on(1)
        self.table.StopButton = True
        self.until("the stop is latched", lambda: "stop_latched" in self.watched(1).inputs())
        self.until_motor_stands(1)
        self.table.StopButton = False
        self.assert_stays(1, cycles=20)
        self.assertEqual(self.table.Stage, self.OFF)


if __name__ == "__main__":
    main()
