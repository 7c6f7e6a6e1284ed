# SPDX-License-Identifier: Apache-2.0
"""A user's first minutes with CAN: drives of three makes on one bus are there, with good values, and do what they are told."""
from can_stage import FAR, RPM, CanStory, main
from modbus import ACTIVE, AXIS, COMPLETED, DISABLED, DISCRETE, ONLINE, STANDSTILL
from processes import until

NOT_ENABLED_BITS = 0x0C  # operation enabled, fault
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


class TheMotorTurnsInOtherDrives(TheMotorTurns):
    """The same where the manuals leave room: set-points acknowledged, blocks offered, frames as short as their data."""

    drives_on = {"cell": "ld2@9+ack+block,jd@126+short,md@30+short+block"}

    def test_they_are_there(self):
        for axis, node in zip(self.axes, (9, 126, 30)):
            self.assertEqual(axis.get("link_state"), ONLINE)
            self.assertEqual(self.ask("nmt DRIVE", node), "operational")
            until("every value it supports", lambda: (now := axis.block())["valid"] == now["supported"])


if __name__ == "__main__":
    main()
