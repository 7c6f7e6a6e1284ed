# SPDX-License-Identifier: Apache-2.0
"""Bad input: what is no Modbus, a wrong configuration, a device that somebody else has. Each mistake is told by tests/config, any bytes are
by tests/fuzz and tests/unit/modbus_tcp."""
import json
import socket
import struct

from pymodbus.diag_message import ReturnBusCommunicationErrorCountRequest

from modbus import BUSY, NO_ANSWER, ONLINE, Refused
from processes import NEVER, until
from stage import Gateway, Story, main


class WrongBytes(Story):
    def setUp(self):
        super().setUp()
        self.start()

    def open(self):
        connection = socket.create_connection(("127.0.0.1", self.ports[0]), timeout=NEVER)
        self.addCleanup(connection.close)
        return connection

    def is_closed(self, connection):
        try:
            return connection.recv(1) == b""
        except ConnectionResetError:
            return True

    def malformed(self):
        return self.client.execute(ReturnBusCommunicationErrorCountRequest(0, unit=1)).message[0]

    def test_what_is_no_frame_closes_its_connection_and_is_counted(self):
        wrong = {"protocol 1": struct.pack(">HHHBBHH", 1, 1, 6, 1, 3, 0, 1), "length 0": struct.pack(">HHHB", 1, 0, 0, 1),
                 "length 1": struct.pack(">HHHB", 1, 0, 1, 1), "length 255": struct.pack(">HHHB", 1, 0, 255, 1) + bytes(254),
                 "length 65535": struct.pack(">HHHB", 1, 0, 65535, 1), "a web browser": b"GET / HTTP/1.1\r\nHost: drive\r\n\r\n"}
        for count, (name, sent) in enumerate(wrong.items(), 1):
            with self.subTest(name):
                connection = self.open()
                connection.sendall(sent)
                self.assertTrue(self.is_closed(connection))
                self.assertEqual(self.malformed(), count)
                self.assertEqual(self.client.gateway()["map_version"], 1)


class WrongConfiguration(Story):
    def write(self, config):
        path = self.path("gateway.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(config if isinstance(config, str) else json.dumps(config))
        return path

    def assert_nothing_opened(self, listener):
        self.assertEqual(self.sim.ask("exchanges lift"), "0")
        with socket.socket() as probe:
            self.assertNotEqual(probe.connect_ex(("127.0.0.1", int(listener["listen"].rpartition(":")[2]))), 0)

    def test_every_mistake_is_named_at_once_and_nothing_is_opened(self):
        self.simulate()
        listener = self.listener()
        buses = self.buses()
        wrong = {"modbus_tcp": [{**listener, "word_order": "middle-first"}], "buses": buses, "colour": "red"}
        buses[0]["baud"] = "fast"
        buses[0]["drives"][0]["axes"][0]["axis"] = 500
        buses[1]["drives"][0]["profile"] = "kinco-jdd"
        path = self.write(wrong)
        for command in ("run", "check", "map"):
            done = self.command_line(command, path)
            self.assertEqual((done.returncode, done.stdout), (1, ""), done.stderr)
            for pointer in ("/modbus_tcp/0/word_order", "/colour", "/buses/0/baud", "/buses/0/drives/0/axes/0/axis"):
                self.assertRegex(done.stderr, rf"(?m)^{path}:\d+:\d+: {pointer}\b.*")
            self.assert_nothing_opened(listener)

    def test_what_is_no_json_is_named_with_its_line(self):
        done = self.command_line("run", self.write('{\n  "buses": [\n    {"name": }\n  ]\n}'))
        self.assertEqual(done.returncode, 1)
        self.assertIn("gateway.json", done.stderr)
        self.assertRegex(done.stderr, r"\b3\b")

    def test_a_file_that_is_not_there(self):
        done = self.command_line("run", self.path("none.json"))
        self.assertEqual(done.returncode, 1)
        self.assertIn(self.path("none.json"), done.stderr)

    def test_an_unknown_profile_is_named(self):
        buses = self.buses()
        buses[0]["drives"][0]["profile"] = "kinco-jdd"
        done = self.command_line("run", self.write({"modbus_tcp": [self.listener()], "buses": buses}))
        self.assertEqual(done.returncode, 1)
        self.assertIn("/buses/0/drives/0/profile: ", done.stderr)
        self.assertIn("kinco-jdd", done.stderr)


class TakenDevice(Story):
    def was_done(self, axis, command):
        """The kernel itself now and then loses what is on its way in a pseudo-terminal while another process opens it, and the second
        gateway tries each second. So an answer may stay away, and a command behind it be given up."""
        try:
            return axis.command(command)
        except Refused as refused:
            self.assertIn(refused.code, (BUSY, NO_ANSWER))
            return False

    def test_a_second_gateway_says_who_is_in_its_way_and_spoils_nothing(self):
        self.start()
        self.configure(name="second.json")
        second = self.keep(Gateway(self.config)).wait_until_it_listens()
        told = second.wait_for(r"warning bus lift: (.*)")[0][1]
        self.assertIn(self.path("lift"), told)
        self.assertRegex(told, "in use|busy|another")
        self.assertEqual(self.connect().axis(1).get("link_state"), 5)
        # It takes over when the first one has ended.
        for number in (1, 2):
            self.axis(number).until(link_state=ONLINE)
            until("it is enabled", lambda number=number: self.was_done(self.axis(number), "enable"))
            until("and disabled", lambda number=number: self.was_done(self.axis(number), "disable"))
        self.assertEqual(self.client.bus(0)["reconnects"], 0)
        self.gateway.terminate()
        heir = self.connect()
        until("both axes are the second gateway's", lambda: heir.gateway()["axes_online"] == 2)


if __name__ == "__main__":
    main()
