# SPDX-License-Identifier: Apache-2.0
"""The log alone tells what runs, who has commanded what, and what was refused and why."""
from modbus import BAD_VALUE, NO_ADDRESS
from stage import Story, main


class Log(Story):
    def setUp(self):
        super().setUp()
        self.simulate()
        self.configure()
        self.run_gateway("--log-level", "debug")
        self.client = self.connect()
        self.until_online()

    def test_it_begins_with_what_runs(self):
        self.gateway.wait_for(r"info gateway: axisgate \d+\.\d+\.\d+, configuration .*gateway\.json: 2 buses, 2 axes$")
        self.gateway.wait_for(r"info bus \S+: kinco-serial on .*lift, 38400 baud 8N1, 1 drive with 1 axis, timeout \d+ ms, polls \d+/\d+/\d+ ms$")
        self.gateway.wait_for(r"info axis 1 jd-1: Kinco JD \(kinco-jd\) node 1 on bus \S+, 10000 units a turn, no lease$")
        self.gateway.wait_for(r"info axis 2 md-2: Kinco MD \(kinco-md\) node 1 on bus ")
        self.gateway.wait_for(rf"info modbus: listener 127\.0\.0\.1:{self.ports[0]}: a client is a connection, only this machine may command$")

    def test_who_commanded_what_and_what_was_refused(self):
        axis = self.axis(1)
        axis.command("enable")
        axis.set(target_position=25000)
        axis.command("move_absolute")
        for words in ("enable", r"target_position 25000 \(2\.5 rev\)", r"move_absolute, target_position 25000 \(2\.5 rev\)"):
            self.gateway.wait_for(rf"info axis 1 jd-1: 127\.0\.0\.1:\d+: {words}$")
        axis.command("disable")
        self.gateway.wait_for(r"info axis 1 jd-1: 127\.0\.0\.1:\d+: disable$")
        with self.refused(BAD_VALUE):
            self.client.write(154, 77)
        self.gateway.wait_for(r"info modbus: 127\.0\.0\.1:\d+: a write to register 154 of axis 1, command is refused: "
                              r"value outside limits \(exception 0x03 illegal data value\)$")
        with self.refused(NO_ADDRESS):
            self.client.registers(9999, 1)
        self.gateway.wait_for(r"debug modbus: 127\.0\.0\.1:\d+: function 0x03 is answered with exception 0x02 illegal data address$")


if __name__ == "__main__":
    main()
