# SPDX-License-Identifier: Apache-2.0
"""The cable of a Keya is pulled while both motors run, and put back: the drive stops by itself where it has a watchdog, and whatever it
did, nothing is enabled or started by the gateway."""
from keya_stage import CANOPEN, KEYA_CAN, RPM, RS232, RS485, KeyaStory, main, on
from modbus import (ALARM_ADOPTED, ALARM_STOP_LATCHED, DISABLED, FAILED, LINK_DOWN, NO_PATH, OFFLINE, ONLINE)
from processes import until

HEARTBEAT_LOST = 0x8130


class CableCut(KeyaStory):
    """`pull` and `put_back` are control words of the simulator, `gone` what the axes read meanwhile."""

    def cut(self, interface, pull, put_back, gone):
        self.begin(interface)
        motions = self.run_both()
        self.sim.ask(pull)
        self.assert_gone(gone)
        if interface.loss:
            self.assert_stopped_by_its_watchdog()
            where = self.positions()
            self.sim.ask(put_back)
            for axis, motion in zip(self.seen, motions):
                axis.until(link_state=ONLINE, axis_state=DISABLED, motion_state=FAILED, motion_id=motion)
            self.assert_nothing_is_enabled_by_itself(where)
        else:
            self.assert_runs_on()
            self.sim.ask(put_back)
            self.stop_what_ran_on(motions)
        self.assert_fresh_enable_works()

    def assert_gone(self, gone):
        for axis in self.seen:
            block = axis.until(link_state=gone)
            self.assertEqual((block["statusword"], block["valid"], block["error_code"]), (0, 0, HEARTBEAT_LOST))
            self.assertEqual(axis.inputs() - {"warning"}, set())
        for axis in self.axes:
            for name in ("enable", "run_velocity"):
                with self.refused(NO_PATH):
                    axis.command(name)
            with self.refused(NO_PATH):
                axis.set(target_velocity=RPM)
        self.assertEqual(self.watcher.gateway()["axes_online"], 0)

    def stop_what_ran_on(self, motions):
        for axis, motion in zip(self.axes, motions):
            block = axis.until(link_state=ONLINE, motion_state=FAILED, motion_id=motion)
            self.assertTrue(block["axis_alarms"] & ALARM_ADOPTED)
            self.assertIn("enabled", axis.inputs())
        self.assertEqual(self.enabled(), [True, True])
        for axis in self.axes:
            axis.command("quick_stop")
            axis.until_input("enabled", False)
        self.until_it_stands()
        for axis in self.seen:
            until("no longer adopted", lambda: not axis.get("axis_alarms") & ALARM_ADOPTED)
        self.assert_nothing_is_enabled_by_itself()


class PortIsGone(CableCut):
    """The adapter is pulled from the computer."""

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_nothing_is_enabled_or_started(self, interface):
        self.cut(interface, "unplug cart", "plug cart", LINK_DOWN)


class DriveFallsSilent(CableCut):
    """The port is still there, and nobody answers."""

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_nothing_is_enabled_or_started(self, interface):
        words = ("connect cart/1 off", "connect cart/1 on") if interface.on_can else ("unresponsive cart/1 on", "clear cart/1")
        self.cut(interface, *words, OFFLINE)


class OnlyTheAnswersAreLost(KeyaStory):
    """The drive hears and its answers do not arrive: it must not be kept alive blindly."""

    @on(RS232, RS485, KEYA_CAN)
    def test_it_is_not_kept_alive_blindly(self, interface):
        self.begin(interface)
        self.run_both()
        self.ask("lose", "on")
        for axis in self.seen:
            axis.until(link_state=OFFLINE)
        if interface.loss:
            self.assert_stopped_by_its_watchdog()
        else:
            self.assert_runs_on()
        self.ask("clear")
        for axis in self.seen:
            axis.until(link_state=ONLINE, motion_state=FAILED)
        for axis in self.axes:
            axis.command("quick_stop")
            axis.until_input("enabled", False)
        self.until_it_stands()
        self.assert_nothing_is_enabled_by_itself()
        self.assert_fresh_enable_works()


class OwnerDiesWhileTheCableIsOut(KeyaStory):
    """No stop of its lease reaches the drive; by RS485 it runs on, and is stopped when it is found running."""

    def test_on_rs485(self):
        self.begin(RS485, lease={"timeout_ms": 1500})
        self.run_both()
        self.sim.ask("unplug cart")
        for axis in self.seen:
            axis.until(link_state=LINK_DOWN, owner=0)
        self.assert_runs_on()
        self.sim.ask("plug cart")
        for axis in self.seen:
            axis.until(link_state=ONLINE)
        self.until_it_stands()
        for axis in self.seen:
            until("latched", lambda: axis.get("axis_alarms") & ALARM_STOP_LATCHED)
        self.assert_nothing_is_enabled_by_itself()
        self.assert_fresh_enable_works()


if __name__ == "__main__":
    main()
