# SPDX-License-Identifier: Apache-2.0
"""The serial CAN adapter is pulled from its socket and put back; a gateway starts before it is there; the bus behind it is in trouble."""
from can_stage import FAR, RPM, CanStory, main
from modbus import (CONTINUOUS, DISABLED, ERROR_STOP, FAILED, LINK_DOWN, NO_PATH, ONLINE, SETUP, STANDSTILL)
from processes import until


class Adapter(CanStory):
    """Two buses, each behind its own adapter; the first is pulled."""

    drives_on = {"cell": "ld2@1,jd@2,md@3", "other": "md@1"}

    def setUp(self):
        super().setUp()
        self.begin()
        for axis in self.axes:
            self.prepare(axis)
        self.lost, self.kept = self.axes[:3], self.axes[3]

    def assert_gone(self):
        for axis in self.lost:
            axis.until(link_state=LINK_DOWN)
            block = axis.block()
            self.assertEqual((block["valid"], block["statusword"]), (0, 0))
            self.assertNotEqual(block["error_code"], 0)
            for name in ("enable", "disable", "move_absolute"):
                with self.refused(NO_PATH):
                    axis.command(name)
            with self.refused(NO_PATH):
                axis.set(target_velocity=1)
        self.assertEqual((self.client.bus(0)["link"], self.client.bus(1)["link"]), (0, 1))
        gateway = self.client.gateway()
        self.assertEqual((gateway["axes_online"], gateway["alarms"] & 0b11), (1, 0b11))
        self.assert_goes_on(self.kept)
        self.assertEqual(self.client.bus(1)["timeouts"], 0)

    def pull(self):
        self.ask("unplug LINE")
        self.assert_gone()

    def put_back(self, count=1):
        self.ask("plug LINE")
        for axis in self.lost:
            axis.until(link_state=ONLINE)
            self.assertNotIn("enabled", axis.inputs())
        self.assertEqual(self.client.bus(0)["reconnects"], count)

    def assert_each_moves(self):
        for axis in self.lost:
            if axis.get("axis_state") == ERROR_STOP:
                self.reset(axis)
            self.targets[axis.number] = axis.get("position_actual")
            self.move(axis)
            axis.command("disable")
            axis.until(axis_state=DISABLED)

    def test_pulled_again_and_again_at_rest(self):
        for count in range(1, 4):
            self.pull()
            self.put_back(count)
        self.assert_each_moves()
        self.assert_one_request_at_a_time("cell", "other")

    def test_pulled_while_motors_run(self):
        for axis in self.lost:
            axis.command("enable")
        self.lost[0].set(target_position=FAR)
        self.lost[0].command("move_absolute")
        for axis in self.lost[1:]:
            axis.set(target_velocity=300 * RPM)
            axis.command("run_velocity")
            axis.until(axis_state=CONTINUOUS)
        self.lost[0].until_input("moving")
        self.pull()
        for axis in self.lost:
            until("it notices", lambda: self.ask("state DRIVE", axis.number) == "fault")
        self.put_back()
        for axis in self.lost:
            axis.until(axis_state=ERROR_STOP, motion_state=FAILED)
        self.assert_each_moves()

    def test_the_bus_behind_it_is_off(self):
        self.ask("bus-off LINE on")
        self.assert_gone()
        self.ask("bus-off LINE off")
        for axis in self.lost:
            axis.until(link_state=ONLINE)
        self.assert_each_moves()


    def test_a_frame_that_nobody_acknowledged_is_no_reason_to_give_up(self):
        for _ in range(3):
            self.ask("no-ack LINE")
            self.assert_goes_on(*self.axes)
        self.assertEqual(self.client.bus(0)["link"], 1)


class AtStart(CanStory):
    def test_an_adapter_that_appears_after_the_gateway(self):
        self.configure()
        self.run_gateway()
        self.gateway.wait_for(r"warning bus cell: .*cell.*trying again")
        self.client = self.connect()
        with self.refused(NO_PATH):
            self.axis(1).command("enable")
        self.simulate()
        self.until_online()
        self.axis(1).command("enable")
        self.axis(1).until(axis_state=STANDSTILL)
        self.assertEqual(len(self.gateway.found("trying again")), 1, "said once, not each second")

    def test_pulled_during_setup(self):
        self.simulate()
        self.ask("reply-delay LINE 40")
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        first = self.axis(1)
        first.until(link_state=SETUP)
        self.ask("unplug LINE")
        first.until(link_state=LINK_DOWN)
        self.ask("reply-delay LINE 1")
        self.ask("plug LINE")
        self.until_online()
        first.command("enable")
        first.until(axis_state=STANDSTILL)


if __name__ == "__main__":
    main()
