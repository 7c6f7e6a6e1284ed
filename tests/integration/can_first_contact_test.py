# SPDX-License-Identifier: Apache-2.0
"""A user's first minutes with CAN: drives of three makes on one bus are there, with good values, and do what they are told."""
from can_stage import FAR, RPM, TURN, CanStory, main
from modbus import (ABORTED, ACTIVE, AXIS, COMPLETED, CONTINUOUS, DISABLED, DISCRETE, ONLINE, REFUSED, STANDSTILL)
from processes import until

NOT_ENABLED_BITS = 0x0C  # operation enabled, fault
POSITION_VALID = 1 << 2
HOME_HERE = 35
NO_TORQUE = ("switch_on_disabled", "ready_to_switch_on")  # a Kinco is told 6 once its connection is up


class FirstContact(CanStory):
    def setUp(self):
        super().setUp()
        self.begin()

    def test_all_axes_are_there_with_good_values_and_nothing_is_enabled(self):
        gateway = self.client.gateway()
        self.assertEqual((gateway["axis_count"], gateway["axes_online"], gateway["gateway_state"]), (3, 3, 1))
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                block = axis.block()
                self.assertEqual(set(block), set(AXIS))
                self.assertEqual((block["link_state"], block["axis_state"], block["error_code"]), (ONLINE, DISABLED, 0))
                self.assertEqual(block["statusword"] & NOT_ENABLED_BITS, 0, "enabled by itself, or faulted")
                until("every value it supports", lambda: (now := axis.block())["valid"] == now["supported"])
                self.assertEqual(axis.inputs() & {"online", "ready", "enabled", "fault"}, {"online", "ready"})
                self.assertEqual(self.client.overview(axis.number)["link_state"], ONLINE)
                self.assertIn(self.ask("state DRIVE", axis.number), NO_TORQUE)
                self.assertEqual(self.ask("nmt DRIVE", axis.number), "operational")
        counts = self.client.bus(0)
        self.assertEqual((counts["link"], counts["timeouts"], counts["late_replies"], counts["bad_frames"]), (1, 0, 0, 0))
        self.assert_one_request_at_a_time()

    def test_each_watches_the_gateway_and_is_watched(self):
        for number in (1, 2):
            self.assertEqual(int(self.ask("get DRIVE 1016.01", number).split()[0]), 127 << 16 | 1500)
            self.assertEqual(int(self.ask("get DRIVE 1017.00", number).split()[0]), 1000)
        self.assertEqual([int(self.ask(f"get DRIVE {name}", 3).split()[0]) for name in ("100C.00", "100D.00", "6007.00")], [500, 3, 1])
        for axis in self.axes:
            self.assertEqual(axis.get("axis_alarms") & 1, 0, "no_comm_watchdog")

    def test_a_second_start_of_the_gateway_writes_nothing_that_the_drives_hold(self):
        self.assertEqual(self.gateway.terminate(), 0)
        before = [self.ask("writes DRIVE 6040.00", number) for number in (1, 2, 3)]
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        # A Leadshine needs no word of ours after its connection came up.
        self.assertEqual(self.ask("writes DRIVE 6040.00", 1), before[0])
        for number in (1, 2, 3):
            self.assertIn(self.ask("state DRIVE", number), NO_TORQUE)
            self.assertEqual(self.ask("stores DRIVE", number), "0", "nothing wears the drive's memory")


class TheMotorTurns(CanStory):
    """What a PLC does with an axis in its first hour, on each of them."""

    def setUp(self):
        super().setUp()
        self.begin()

    def test_enable_move_and_disable(self):
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                self.prepare(axis)
                axis.command("enable")
                self.assertEqual(axis.get("axis_state"), STANDSTILL)
                self.assertAlmostEqual(axis.get("position_actual"), 0, delta=20, msg="enabling moves nothing")
                self.move(axis)
                axis.set(target_position=FAR, profile_velocity=60 * RPM)
                number = axis.command("move_absolute")
                axis.until(motion_state=ACTIVE, axis_state=DISCRETE, motion_id=number)
                axis.until_input("moving")
                axis.set(target_position=0, profile_velocity=600 * RPM)
                axis.command("move_absolute")  # takes the place of the other
                axis.until(motion_state=COMPLETED)
                until("it is back", lambda: abs(axis.get("position_actual")) <= 20)
                axis.command("disable")
                axis.until(axis_state=DISABLED)
                for other in self.axes:
                    self.assertNotIn("enabled", other.inputs())
        self.assertEqual(self.client.bus(0)["late_replies"], 0)
        self.assert_one_request_at_a_time()

    def test_run_halt_and_quick_stop(self):
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                self.prepare(axis)
                axis.command("enable")
                axis.set(target_velocity=300 * RPM)
                axis.command("run_velocity")
                axis.until(axis_state=CONTINUOUS)
                until("its speed", lambda: abs(axis.get("velocity_actual") - 300 * RPM) <= 5 * RPM)
                axis.command("halt")
                until("it stands", lambda: abs(axis.get("velocity_actual")) <= RPM)
                self.assertIn("enabled", axis.inputs())
                axis.until(motion_state=ABORTED, axis_state=STANDSTILL)
                axis.set(target_velocity=-300 * RPM)
                axis.command("run_velocity")
                until("the other way", lambda: abs(axis.get("velocity_actual") + 300 * RPM) <= 5 * RPM)
                axis.command("quick_stop")
                until("it stands", lambda: abs(axis.get("velocity_actual")) <= RPM)
                self.assertIn("stop_latched", axis.inputs())
                with self.refused(REFUSED):
                    axis.command("run_velocity")
                axis.command("disable")
                axis.until_input("enabled", False)

    def test_homing_where_it_stands(self):
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                self.prepare(axis)
                self.move(axis)
                axis.set(homing_method=HOME_HERE)
                number = axis.command("home")
                axis.until(motion_state=COMPLETED, motion_id=number)
                axis.until_input("homed")
                until("here is 0", lambda: abs(axis.get("position_actual")) <= 20)
                axis.until(axis_state=STANDSTILL)
                self.targets[axis.number] = 0
                self.move(axis)
                axis.command("disable")


class TheMotorTurnsInOtherDrives(TheMotorTurns):
    """The same where the manuals leave room: set-points acknowledged, blocks offered, frames as short as their data."""

    drives_on = {"cell": "ld2@9+ack+block,jd@126+short,md@30+short+block"}

    def test_they_are_there(self):
        for axis, node in zip(self.axes, (9, 126, 30)):
            self.assertEqual(axis.get("link_state"), ONLINE)
            self.assertEqual(self.ask("nmt DRIVE", node), "operational")
            until("every value it supports", lambda: (now := axis.block())["valid"] == now["supported"])

class ProcessData(CanStory):
    """Nothing is polled for a minute: what changes comes by itself."""

    timings = {**CanStory.timings, "decode": True, "poll": {"fast": 60000, "normal": 60000, "slow": 600000}}

    def test_state_and_position_arrive_while_it_moves(self):
        self.begin()
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                axis.set(profile_velocity=300 * RPM, profile_acceleration=30000, profile_deceleration=30000)
                axis.command("enable")
                axis.set(target_position=5 * TURN)
                read = fr"node {axis.number}: SDO value 606[34]:00"
                before = len(self.gateway.found(read))
                axis.command("move_absolute")
                seen = set()

                def has_arrived():
                    block = axis.block()
                    if block["valid"] & POSITION_VALID:
                        seen.add(block["position_actual"])
                    return block["motion_state"] == COMPLETED

                until("it has arrived", has_arrived)
                reads = len(self.gateway.found(read)) - before
                self.assertGreater(len(seen), reads + 3, "its way was not told but read")
                until("it is there", lambda: abs(axis.get("position_actual") - 5 * TURN) <= 20)
                axis.command("disable")
                axis.until(axis_state=DISABLED)
                axis.until_input("enabled", False)

    def test_a_fault_is_told_at_once(self):
        self.begin()
        for axis, fault in zip(self.axes, ("fault DRIVE 0x2211", "fault DRIVE 2601 0x0020", "fault DRIVE 2601 0x0020")):
            with self.subTest(axis=axis.number):
                self.ask(fault, axis.number)
                axis.until_input("fault")
                until("its code", lambda: axis.get("error_code") not in (0, 0xFFFF))
                others = [other for other in self.axes if other.number > axis.number]
                self.assertFalse(any("fault" in other.inputs() for other in others))


if __name__ == "__main__":
    main()
