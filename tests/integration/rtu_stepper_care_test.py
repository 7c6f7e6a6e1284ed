# SPDX-License-Identifier: Apache-2.0
"""What the gateway does for an iD286pro that no servo needs: it stops the motor when its client leaves, and spares its EEPROM."""
from modbus import ABORTED, ALARM_ADOPTED, ALARM_STOP_LATCHED, AXIS, CONTINUOUS, encode, mbpoll
from processes import until
from rtu_stepper_test import FAR, RPM, STEPPER, TURN, Stepper
from stage import Story, main


class Leaving(Stepper):
    """Nothing but the gateway stops this drive: it watches no line."""

    def setUp(self):
        Story.setUp(self)
        self.begin(listeners=[self.listener(), self.listener(client="address")])
        self.enable()

    def run_for(self, client):
        mover = client.axis(1)
        mover.set(target_velocity=60 * RPM)
        mover.command("run_velocity")
        self.until_velocity(60)

    def test_the_motion_ends_with_the_connection_that_commanded_it(self):
        first, second = self.connect(), self.connect()
        self.run_for(first)
        second.close()
        self.assertEqual(self.stepper.get("axis_state"), CONTINUOUS, "another client's end is no reason")
        first.close()
        block = self.stepper.until(motion_state=ABORTED)
        self.assertTrue(block["axis_alarms"] & ALARM_STOP_LATCHED)
        self.until_it_stands()
        self.gateway.wait_for("axis 1: the client that commanded the motion is gone: quick stop")

    def test_a_command_that_another_client_has_replaced_is_no_more_the_first_ones(self):
        first, second = self.connect(), self.connect()
        self.run_for(first)
        self.run_for(second)
        first.close()
        self.until_velocity(60)
        self.assertEqual(self.stepper.get("axis_state"), CONTINUOUS)
        second.close()
        self.stepper.until(motion_state=ABORTED)

    def test_where_an_address_is_the_client_it_outlives_its_connections(self):
        # One-shot tools end their connection with each call: the axis goes on until the next call tells it to stop.
        one_shot = self.connect(1)
        self.run_for(one_shot)
        one_shot.close()
        position = self.stepper.get("position_actual")
        until("it runs on", lambda: self.stepper.get("position_actual") > position + TURN)
        self.assertEqual(self.stepper.get("axis_state"), CONTINUOUS)
        mbpoll(self.ports[1], "4", 154, 4)
        self.stepper.until(motion_state=ABORTED)
        self.until_it_stands()

    def test_a_gateway_that_is_ended_leaves_it_running_and_the_next_one_stops_it(self):
        self.run_for(self.client)
        written = self.commands()
        self.assertEqual(self.gateway.terminate(), 0)
        self.gateway.wait_for("signal 15: ending; the drives keep what they do")
        self.assertEqual(self.gateway.found("quick stop|stop_latched"), [], "it says so only where it does so")
        self.assertEqual((self.commands(), self.sim.state(STEPPER)), (written, "running"))
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.stepper = self.axis(1)
        self.assertTrue(self.stepper.get("axis_alarms") & ALARM_ADOPTED)
        self.assertEqual(self.commands(), written, "nothing is written to a drive found running")
        self.stepper.command("quick_stop")
        self.until_it_stands()


class Memory(Stepper):
    """Its EEPROM bears a million writes: what a scanner repeats costs it nothing."""

    SCANS = 300

    def scan(self, axis, target):
        rows = (("controlword", 0), ("mode", 0), ("target_position", target), ("target_velocity", 0))
        self.client.write(axis.first + 40, *[word for name, value in rows for word in encode(AXIS[name][1], value)])
        rates = (("profile_velocity", 600 * RPM), ("profile_acceleration", 300000), ("profile_deceleration", 300000))
        self.client.write(axis.first + 48, *[word for name, value in rates for word in encode(AXIS[name][1], value)])

    def test_a_scanner_that_writes_the_same_block_for_ever_wears_nothing(self):
        self.stepper.set(position_limit_min=-FAR, position_limit_max=FAR)  # stored registers, written once
        self.scan(self.stepper, TURN)
        worn = self.sim.ask(f"eeprom {STEPPER}")
        written = [self.sim.ask(f"writes {STEPPER} {register}") for register in (303, 304, 306, 307, 313)]
        self.assertRegex(worn, r"317:1\b")
        for _ in range(self.SCANS):
            self.scan(self.stepper, TURN)
            self.stepper.set(position_limit_min=-FAR, position_limit_max=FAR)
        self.assertEqual(self.sim.ask(f"eeprom {STEPPER}"), worn)
        self.assertEqual([self.sim.ask(f"writes {STEPPER} {register}") for register in (303, 304, 306, 307, 313)], written)

    def test_a_restarted_gateway_finds_what_is_stored_and_leaves_it(self):
        self.stepper.set(position_limit_max=FAR, target_position=TURN)
        worn = self.sim.ask(f"eeprom {STEPPER}")
        self.gateway.terminate()
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.axis(1).set(position_limit_max=FAR, target_position=TURN)
        self.assertEqual(self.sim.ask(f"eeprom {STEPPER}"), worn)


if __name__ == "__main__":
    main()
