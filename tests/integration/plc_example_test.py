# SPDX-License-Identifier: Apache-2.0
"""The programs that the manual prints, with blocks and without, run as they stand there: images at %IW and %QW, a switch and two buttons.

Both go through the same stories. Whatever has ended their motion, and whatever has come back since, the motor's own counts stay as they are,
and no enable, homing or move is written, until the reset button is pressed or the switch turned on anew.
"""
import json
import re
import time
from types import SimpleNamespace

from modbus import ONLINE
from plc_stage import PLC, AxisRules, PlcStory, Scanner, StMachine, Unplugged, main, text_of
from stage import Story

PLACES = (10.0, 25.0, -5.0)  # mm
COUNTS_PER_MM = 2000  # of the drive's encoder
TRIP = "2601 0x0020"
COMMAND, ID = 14, 15  # words of the image
MAKES_IT_GO = {1: "enable", 6: "move_absolute", 10: "home"}
SOME_CYCLES = 40


class Controller:
    """Runs a program for axis 1 as a PLC does: inputs, program, outputs."""

    stations = {}
    name, texts = "", ()

    def __init__(self, story, cycle_ms=10):
        self.story, self.scanner, self.cycle = story, Scanner(story.ports[0], PLC), cycle_ms / 1000
        self.machine = StMachine(*map(text_of, self.texts))
        self.program = self.machine.new(self.name)
        self.places = self.machine.places(self.name)
        self.reads = [(place, first, count) for place, first, count in (("%IW0", 100, 39), ("%IW39", 178, 18)) if place in self.places]
        self.commands, self.last = [], (0, 0)  # all that it ever asked for, newest last
        story.plcs.append(self)
        story.addCleanup(self.scanner.close)

    def image(self, place):
        return getattr(self.program, self.places[place])

    def step(self):
        time.sleep(self.cycle)
        try:
            if self.scanner.connect():
                self.scanner.write(140, self.image("%QW0"))
                for place, first, count in self.reads:
                    self.image(place)[:] = self.scanner.read(first, count) or self.image(place)
        except Unplugged:
            self.scanner.close()
        self.program.ScannerOk = self.scanner.connected()
        self.machine.now = int(time.monotonic() * 1000)
        self.program.run()
        asked = self.image("%QW0")[COMMAND], self.image("%QW0")[ID]
        if asked != self.last:
            self.last = asked
            self.commands.append(asked[0])
        self.check()

    def check(self):
        """What must be so after each cycle."""

    def unplug(self):
        """Its network cable: nothing is said on the connection, not even its end."""
        self.scanner.plugged = False
        left, self.scanner.socket = self.scanner.socket, None
        if left:
            self.story.addCleanup(left.close)

    def without_power(self):
        self.unplug()
        self.story.plcs.remove(self)

    def started_again(self):
        """Its variables are retained, but for the one that the program says is not; its outputs are 0."""
        self.program.Started = False
        self.image("%QW0")[:] = [0] * 17
        self.scanner.plugged = True
        self.story.plcs.append(self)


class WithBlocks(Controller):
    name, texts = "Table", ("deploy/plc/axisgate.st", "deploy/plc/example.st")

    def __init__(self, story):
        super().__init__(story)
        table = self.program
        table.Axis1.AckTimeout = 60000  # a busy machine is no deaf gateway
        self.rules = AxisRules(SimpleNamespace(Axis=table.Axis1, Power=table.Power1, Reset=table.Reset1, Stop=table.Stop1, Home=table.Home1,
                                               MoveAbsolute=table.Move1, ReadStatus=table.Status1))

    def check(self):
        broken = list(self.rules.broken())
        self.story.assertFalse(broken, "PLCopen's rules")

    def is_ready(self):
        return self.program.Axis1.Ready

    def has_lost(self):
        return not self.program.Axis1.Online

    def is_under_way(self):
        return self.program.Move1.Active


class WithoutBlocks(Controller):
    name, texts = "Plain", ("deploy/plc/example_plain.st",)

    def __init__(self, story):
        super().__init__(story)
        self.program.AckTimeout = 60000

    def is_ready(self):
        return self.program.Phase == 2

    def has_lost(self):
        return not self.program.Connected

    def is_under_way(self):
        image = self.image("%IW0")
        return self.program.Stage == 3 and image[33] == self.program.MotionId and image[32] == 1


class LeastOfAll(Controller):
    name, texts = "Least", ("deploy/plc/example_least.st",)

    def is_ready(self):
        return self.image("%IW0")[30] == self.image("%QW0")[ID] != 0


class TheLeast(PlcStory):
    """The dozen lines that the guide begins with."""

    lines_of = ("serial",)
    axis_options = {"units_per_rev": 5000, "homing_method": 35}

    def wish(self, number, state):
        self.plc.program.Wish = number
        self.until(f"wish {number} shows", lambda: self.plc.is_ready() and self.plc.image("%IW0")[31] == state)

    def test_it_enables_moves_and_stops_and_goes_on_by_nothing_but_a_new_wish(self):
        self.begin()
        self.plc = LeastOfAll(self)
        self.wish(0, 0)
        self.wish(1, 1)
        self.wish(6, 2)
        self.until("it is there", lambda: self.plc.image("%IW0")[32] == 2)
        self.assertAlmostEqual(self.position(1) / COUNTS_PER_MM, 10.0, delta=0.05)
        self.wish(3, 5)
        self.assertIn("stop_latched", self.watched(1).inputs())
        since = len(self.plc.commands)
        self.plc.unplug()
        self.cycles(5)
        self.plc.scanner.plugged = True
        self.until("it is back", lambda: self.plc.scanner.connected() and self.plc.is_ready())
        self.assert_stays(1, cycles=SOME_CYCLES)
        self.assertEqual(self.plc.commands[since:], [])
        self.wish(1, 1)
        self.wish(2, 0)


class TableWithBlocks(PlcStory):
    lines_of = ("serial",)
    axis_options = {"units_per_rev": 5000, "homing_method": 35}
    controller = WithBlocks

    def setUp(self):
        super().setUp()
        self.begin()
        self.plc = self.controller(self)
        self.table = self.plc.program
        self.until("there is a connection", self.plc.is_ready)

    # What a person does and sees.

    def until_reached(self, place):
        self.until(f"it is on its way to place {place}", lambda: self.table.Place == place and self.plc.is_under_way())
        self.until(f"place {place} is reached", lambda: self.table.Place != place)
        # The next command is still in the image, and the motor stands.
        self.assertAlmostEqual(self.position(1) / COUNTS_PER_MM, PLACES[place - 1], delta=0.05)

    def until_round(self):
        """Each position is reached, one after the other: the motor turns round there."""
        for place in (1, 2, 3):
            self.until_reached(place)

    def set_out(self):
        """Homed, and on its way to the third place, which is the farthest."""
        self.table.SwitchedOn = True
        self.until("it is on its way", lambda: self.table.Place == 3 and self.plc.is_under_way())
        self.until_motor_turns(1)

    def until_switched_off(self):
        self.table.SwitchedOn = False
        self.until("it is disabled", lambda: self.watched(1).get("axis_state") == 0)
        self.until_motor_stands(1)
        self.until("the gateway has seen it stand", lambda: self.watched(1).get("velocity_actual") == 0)

    def press_reset(self):
        self.table.ResetButton = True
        self.cycles(2)
        self.table.ResetButton = False

    def assert_rests(self, since):
        """The motor stands, and nothing that could move it was asked for, since the program had asked for so many commands."""
        self.until("the program would be heard", self.plc.is_ready)
        self.until_motor_stands(1)
        self.assert_stays(1, cycles=SOME_CYCLES)
        self.assertEqual([MAKES_IT_GO[asked] for asked in self.plc.commands[since:] if asked in MAKES_IT_GO], [], self.plc.commands)

    def goes_on_by(self, act):
        """What a person does now makes it go on to the position that is next."""
        act()
        self.until("it is on its way", self.plc.is_under_way)
        self.until_reached(self.table.Place)
        self.until_switched_off()

    def turn_on_anew(self):
        self.until_switched_off()
        self.table.SwitchedOn = True

    # The stories.

    def test_three_positions_a_stop_and_a_reset(self):
        table = self.table
        table.SwitchedOn = True
        self.until_round()
        self.until_motor_turns(1)
        since = len(self.plc.commands)
        table.StopButton = True
        self.until("the stop is latched", lambda: "stop_latched" in self.watched(1).inputs())
        self.assert_rests(since)
        table.StopButton = False
        # With blocks the drive has its torque again, as AXG_Power says. Where it stands.
        self.until_motor_stands(1)
        self.assert_stays(1, cycles=SOME_CYCLES)
        self.assertFalse({6, 10} & set(self.plc.commands[since:]), self.plc.commands)
        self.press_reset()
        self.until_round()
        self.until_motor_turns(1)
        self.sim.ask(f"fault serial/1 {TRIP}")
        self.until("the fault is told", lambda: self.watched(1).get("axis_state") == 6)
        self.cycles(2)  # the program has seen it: before, its next position may have been due
        since = len(self.plc.commands)
        self.until_motor_stands(1)
        self.sim.ask(f"clear serial/1 {TRIP}")
        self.assert_rests(since)
        self.goes_on_by(self.press_reset)

    def test_a_lost_connection_starts_nothing_when_it_is_back(self):
        for act in (self.press_reset, self.turn_on_anew):
            self.set_out()
            since = len(self.plc.commands)
            self.plc.unplug()
            self.until("the loss is noticed", self.plc.has_lost)
            self.cycles(5)
            self.plc.scanner.plugged = True
            # What was under way ends there: no lease has run out in this story.
            self.assert_rests(since)
            self.goes_on_by(act)

    def test_a_drive_out_of_sight_starts_nothing_when_it_is_back(self):
        self.set_out()
        since = len(self.plc.commands)
        self.sim.ask("unplug serial")
        self.until("the loss is noticed", lambda: self.watched(1).get("axis_state") == 7)
        self.cycles(5)
        self.sim.ask("plug serial")
        self.until("the drive is back", lambda: self.watched(1).get("link_state") == ONLINE)
        self.assert_rests(since)
        self.goes_on_by(self.press_reset)

    def test_a_drive_that_was_started_anew_is_homed_before_it_moves(self):
        """Where it stands is its zero then: a program that went on to its next place would go to a wrong one."""
        self.set_out()
        since = len(self.plc.commands)
        self.sim.ask("restart serial/1")
        self.until("the program has seen it", lambda: self.table.Tripped)
        self.until("the drive is back", lambda: self.watched(1).get("link_state") == ONLINE)
        self.assert_rests(since)
        self.press_reset()
        self.until_round()
        self.assertEqual([MAKES_IT_GO[asked] for asked in self.plc.commands[since:] if asked in MAKES_IT_GO][:3],
                         ["enable", "home", "move_absolute"], self.plc.commands)

    def test_what_another_client_has_stopped_is_not_begun_again(self):
        panel = self.peer("127.0.0.2").axis(1)
        for how in ("halt", "quick_stop", "disable"):
            self.set_out()
            since = len(self.plc.commands)
            panel.command(how)
            self.assert_rests(since)
            self.goes_on_by(self.press_reset)

    def test_a_start_of_the_controller_starts_nothing(self):
        self.set_out()
        self.plc.without_power()
        self.plc = self.controller(self)
        self.table = self.plc.program
        self.table.SwitchedOn = True
        self.assert_rests(0)
        self.goes_on_by(self.turn_on_anew)

    def test_a_start_with_retained_variables_starts_nothing(self):
        """The switch was turned on while the controller had no power."""
        self.set_out()
        self.until_switched_off()
        since = len(self.plc.commands)
        self.plc.without_power()
        self.table.SwitchedOn = True
        self.plc.started_again()
        self.assert_rests(since)
        self.goes_on_by(self.press_reset)

    def test_its_stop_button_stops_what_another_client_moves_and_nothing_follows(self):
        panel = self.peer("127.0.0.2").axis(1)
        panel.set(profile_velocity=300000, target_position=50000000)
        panel.command("enable")
        self.until("the axis is enabled", lambda: "enabled" in self.watched(1).inputs())  # "posted": not with the answer
        self.cycles(2)  # each state is seen
        panel.command("move_absolute")
        self.until_motor_turns(1)
        self.cycles(20)
        self.assert_turns_on(1)
        self.table.StopButton = True
        self.until("the stop is latched", lambda: "stop_latched" in self.watched(1).inputs())
        self.until_motor_stands(1)
        self.table.StopButton = False
        self.assert_rests(0)


class TableWithoutBlocks(TableWithBlocks):
    controller = WithoutBlocks

    def test_three_positions_a_stop_and_a_reset(self):  # a class is run where it has a test of its own; the others are inherited
        super().test_three_positions_a_stop_and_a_reset()


class PrintedConfiguration(Story):
    def test_it_is_valid_and_fits_the_program(self):
        _, page = text_of("docs/plc.md")
        text = re.search(r"^```json\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)[1]
        with open(self.path("gateway.json"), "w", encoding="utf-8") as file:
            file.write(text)
        checked = self.command_line("check", self.path("gateway.json"))
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        made = json.loads(text)
        axis = made["buses"][0]["drives"][0]["axes"][0]
        self.assertEqual({key: axis[key] for key in TableWithBlocks.axis_options}, TableWithBlocks.axis_options)
        self.assertEqual({key: made["modbus_tcp"][0][key] for key in TableWithBlocks.listener_options}, TableWithBlocks.listener_options)
        self.assertEqual(axis["lease"]["renew"], "heartbeat")


if __name__ == "__main__":
    main()
