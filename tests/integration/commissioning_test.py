# SPDX-License-Identifier: Apache-2.0
"""Before the first run: check a configuration and a profile, commission a drive as it left the factory, look at the table."""
import json
import shutil

from modbus import ALARM_LOCAL_CONTROL, ONLINE, REFUSED, STANDSTILL
from processes import until
from stage import SOURCE, Story, bus, drive, main

# What decides over the bus on a JD: the functions of DIN1 to DIN8, and the store command.
SETTINGS = ["2010.03", "2010.04", "2010.05", "2010.06", "2010.07", "2010.08", "2010.09", "2010.1D", "2FF0.01", "6040.00", "6060.00"]
ENABLE_FUNCTION = 1


class FactoryFresh(Story):
    lines = {"lift": "jd@1+fresh"}

    def buses(self):
        return [bus(self.path("lift"), drive("jd", 1, 1))]

    def commission(self, *options, answer=""):
        return self.command_line("commission", self.config, "1", *options, answer=answer)

    def stores(self):
        return int(self.sim.ask("stores lift/1"))

    def test_it_cannot_be_enabled_and_says_why(self):
        self.start()
        axis = self.axis(1)
        self.assertTrue(axis.get("axis_alarms") & ALARM_LOCAL_CONTROL)
        self.assertTrue(self.client.gateway()["alarms"] & 1 << 5)
        self.assertIn("warning", axis.inputs())
        self.gateway.wait_for("DIN1 has the function drive enable")
        with self.refused(REFUSED):
            axis.command("enable")
        named = "alarm local_control: the drive obeys its own inputs or keypad and ignores the bus; axisgate commission CONFIG 1 shows and changes it"
        self.gateway.wait_for(rf"enable is refused: .*: {named}$|enable: .*: {named}$")
        by_hand = self.command_line("enable", f"127.0.0.1:{self.ports[0]}", "1")
        self.assertIn(named, by_hand.stderr)
        self.assertNotIn("operation", self.sim.state("lift/1"))
        self.assertEqual(self.sim.writes("lift/1", *SETTINGS[:-2]), 0, "a person decides over these")

    def test_no_writes_nothing(self):
        self.simulate()
        self.configure()
        for answer in ("no\n", "\n", "", "y\n", "YES\n"):
            done = self.commission(answer=answer)
            self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
            self.assertIn("BAD  din1_local_control", done.stdout)
            self.assertIn("nothing was written", done.stdout)
        self.assertEqual(self.sim.writes("lift/1", *SETTINGS), 0)
        self.assertEqual(self.stores(), 0)

    def test_yes_cures_it_and_it_stays_cured(self):
        self.simulate()
        self.configure()
        self.assertEqual(self.sim.object("lift/1", "2010.03"), ENABLE_FUNCTION)
        done = self.commission("--yes")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("din1_local_control: reads as it should", done.stdout)
        self.assertEqual(self.sim.object("lift/1", "2010.03"), 0)
        self.assertNotIn("operation", self.sim.state("lift/1"))
        until("stored", lambda: self.stores() >= 1)
        self.assertIn("nothing to remedy", self.commission().stdout)
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.assertFalse(self.axis(1).get("axis_alarms") & ALARM_LOCAL_CONTROL)
        before = self.client.bus(0)["timeouts"]
        self.sim.ask("restart lift/1")
        # It may be over between two looks at link_state.
        until("the drive is missed", lambda: self.client.bus(0)["timeouts"] > before)
        axis = self.axis(1)
        axis.until(link_state=ONLINE)
        axis.command("enable")
        axis.until(axis_state=STANDSTILL)

    def test_beside_a_running_gateway_it_gives_up_and_spoils_nothing(self):
        self.start()
        done = self.commission("--yes")
        self.assertEqual(done.returncode, 1)
        self.assertIn("a gateway runs with ", done.stderr)
        self.assertNotIn("waiting for the drive", done.stdout)
        self.assertEqual(self.stores(), 0)
        self.axis(1).until(link_state=ONLINE)

    def test_an_axis_that_is_not_configured(self):
        self.configure()
        done = self.command_line("commission", self.config, "9")
        self.assertEqual(done.returncode, 1)
        self.assertIn("no axis 9", done.stderr)

    def test_an_enabled_drive_is_not_touched(self):
        self.simulate()
        self.configure()
        for setting in ("2010.03", "2010.05", "2010.07", "2010.08"):
            self.sim.ask(f"set lift/1 {setting} 0")
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.axis(1).command("enable")
        self.gateway.terminate()
        self.sim.ask("set lift/1 2000.00 1")  # enables itself at power-up: something to remedy
        before = self.sim.writes("lift/1", *SETTINGS, "2000.00")
        done = self.commission("--yes")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("disable it first", done.stderr)
        self.assertEqual(self.sim.writes("lift/1", *SETTINGS, "2000.00"), before)


class AtTheDesk(Story):
    def test_check_prints_the_plan_of_each_bus(self):
        self.configure()
        done = self.command_line("check", self.config)
        self.assertEqual(done.returncode, 0, done.stderr)
        for word in ("lift", "feeder", "jd-1", "md-2", "%"):
            self.assertIn(word, done.stdout)

    def test_profile_check_takes_what_is_shipped(self):
        for name in ("kinco-jd", "kinco-md"):
            done = self.command_line("profile", "check", f"{SOURCE}/schemas/drives/{name}.json")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("is valid", done.stdout)

    def test_profile_check_names_file_and_place_of_each_mistake(self):
        path = self.path("mine.json")
        with open(f"{SOURCE}/schemas/drives/kinco-jd.json", encoding="utf-8") as file:
            profile = json.load(file)
        profile["objects"].setdefault("statusword", {})["type"] = "u17"
        profile["quantities"].setdefault("position_actual", {})["object"] = "nowhere"
        with open(path, "w", encoding="utf-8") as file:
            json.dump(profile, file)
        done = self.command_line("profile", "check", path)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, rf"(?m)^{path}:\d+:\d+: /objects/statusword/type: ")

    def test_a_profile_of_ones_own_beside_the_configuration(self):
        shutil.copy(f"{SOURCE}/schemas/drives/kinco-jd.json", self.folder)
        buses = self.buses()
        buses[0]["drives"][0]["profile"] = self.path("kinco-jd.json")
        self.start(buses=buses)
        self.axis(1).command("enable")
        self.axis(1).until(axis_state=STANDSTILL)


class Top(Story):
    def test_once_tells_a_health_check_whether_the_gateway_answers(self):
        self.start()
        endpoint = f"127.0.0.1:{self.ports[0]}"
        shown = self.command_line("top", endpoint, "--once")
        self.assertEqual(shown.returncode, 0, shown.stderr)
        self.assertIn("axes online 2 of 2", shown.stdout)
        self.sim.ask("unplug lift")
        self.axis(1).until(link_state=5)
        self.assertEqual(self.command_line("top", endpoint, "--once").returncode, 0, "a dead drive is not a dead gateway")
        self.gateway.terminate()
        silent = self.command_line("top", endpoint, "--once")
        self.assertEqual((silent.returncode, silent.stdout), (1, ""))
        self.assertIn(f"cannot read {endpoint}", silent.stderr)


if __name__ == "__main__":
    main()
