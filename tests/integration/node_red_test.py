# SPDX-License-Identifier: Apache-2.0
"""The flow of deploy/examples/node-red. Debian has no Node-RED: what the flow's nodes describe is carried out here, request by request.
tests/node_red/run, which needs npm's registry, tells the same stories with Node-RED itself."""
import json
import re
import struct

from pymodbus.client import ModbusTcpClient

from examples_stage import EXAMPLES, PROGRAMS, Examples, main
from modbus import AXIS, INPUTS, STANDSTILL, Closed, Refused, width
from processes import NEVER, until

SLOW = 5000  # 0.001 rpm: 2.5 turns take half a minute


class Flow:
    """Does with a flow's nodes what Node-RED does, as far as this flow goes: whatever else it holds is refused."""

    SHOWS_32 = re.compile(r"msg\.payload = \(msg\.payload\[(\d+)\] << 16 \| msg\.payload\[(\d+)\]\) / (\d+);\nreturn msg;")
    SHOWS = re.compile(r"msg\.payload = msg\.payload\[(\d+)\];\nreturn msg;")

    def __init__(self, port):
        with open(f"{EXAMPLES}/node-red/flow.json", encoding="utf-8") as file:
            self.nodes = {node["id"]: node for node in json.load(file)}
        self.servers = [name for name, node in self.nodes.items() if node["type"] == "modbus-client"]
        self.tcp = ModbusTcpClient("127.0.0.1", port=port, timeout=NEVER, retries=0)
        self.shown = {}
        if not self.tcp.connect():
            raise Closed("no connection")

    def named(self, kind, name):
        return next(node for node in self.nodes.values() if node["type"] == kind and node["name"] == name)

    def send_on(self, node, payload):
        for wire in node["wires"][0]:
            self.receive(self.nodes[wire], payload)

    def receive(self, node, payload):
        if node["type"] == "modbus-flex-write":
            assert node["server"] in self.servers
            self.carry_out(payload)
            self.send_on(node, payload)
        elif node["type"] == "change":
            (rule,) = node["rules"]
            assert (rule["t"], rule["p"], rule["pt"], rule["tot"]) == ("set", "payload", "msg", "json")
            self.send_on(node, json.loads(rule["to"]))
        elif node["type"] == "function":
            if wide := self.SHOWS_32.fullmatch(node["func"]):
                high, low, scale = map(int, wide.groups())
                self.send_on(node, struct.unpack(">i", struct.pack(">HH", payload[high], payload[low]))[0] / scale)
            else:
                self.send_on(node, payload[int(self.SHOWS.fullmatch(node["func"])[1])])
        elif node["type"] == "debug":
            self.shown[node["name"]] = payload
        else:
            raise AssertionError(f"nobody knows what a {node['type']} does")

    def carry_out(self, payload):
        """As node-red-contrib-modbus takes it: fc, address, quantity, value."""
        assert set(payload) == {"value", "fc", "unitid", "address", "quantity"}
        if payload["fc"] == 5:
            assert payload["quantity"] == 1
            reply = self.tcp.write_coil(payload["address"], payload["value"], slave=payload["unitid"])
        else:
            assert payload["fc"] == 16 and payload["quantity"] == len(payload["value"])
            reply = self.tcp.write_registers(payload["address"], payload["value"], slave=payload["unitid"])
        if reply.isError():
            raise Refused(reply.exception_code)

    def press(self, name, payload=None):
        """`payload`: in place of what the button sends."""
        node = self.named("inject", name)
        assert node["payloadType"] == "json" and not node["once"] and not node["repeat"], "nothing is written by itself"
        self.send_on(node, payload or json.loads(node["payload"]))

    def press_in_vain(self, name):
        """The gateway refuses it."""
        try:
            self.press(name)
        except Refused:
            return
        raise AssertionError(f"{name} was not refused")

    def dies(self):
        """Nothing more comes from it, and its connection stays open."""

    def poll(self):
        for node in list(self.nodes.values()):
            if node["type"] != "modbus-read":
                continue
            function = {"HoldingRegister": self.tcp.read_holding_registers, "Input": self.tcp.read_discrete_inputs}[node["dataType"]]
            reply = function(int(node["adr"]), int(node["quantity"]), slave=int(node["unitid"]))
            assert not reply.isError(), reply
            self.send_on(node, (reply.registers if node["dataType"] == "HoldingRegister" else reply.bits)[:int(node["quantity"])])

    def until(self, name, look):
        def shows():
            self.poll()
            return look(self.shown[name])
        until(f"{name} is shown", shows)


class OfTheFlow(Examples):
    def setUp(self):
        super().setUp()
        self.flow = self.started()

    def started(self):
        flow = Flow(self.ports[PROGRAMS])
        self.addCleanup(flow.tcp.close)
        return flow


class NodeRed(OfTheFlow):
    lease_ms = 30000

    def test_what_it_shows_are_the_rows_of_their_names(self):
        flow = self.flow
        for node in (node for node in flow.nodes.values() if node["type"] == "function"):
            read = next(each for each in flow.nodes.values() if each["type"] == "modbus-read" and node["id"] in each["wires"][0])
            shown = flow.nodes[node["wires"][0][0]]["name"]
            places = [int(read["adr"]) + int(place) for place in re.findall(r"payload\[(\d+)\]", node["func"])]
            if read["dataType"] == "Input":
                self.assertEqual(places, [100 + INPUTS.index(shown)])
            else:
                offset, kind = AXIS[shown]
                self.assertEqual(places, [100 + offset + place for place in range(width(kind))])

    def test_no_node_names_its_connection_but_where_it_means_it(self):
        """Node-RED takes every value that is the id of a connection for a reference to it: one that was called as its id is was refused
        as circular, and nothing ran."""
        for node in self.flow.nodes.values():
            named = {key for key, value in node.items() if key != "id" and value in self.flow.servers}
            self.assertEqual(named, {"server"} if node["type"].startswith("modbus-") and node["id"] not in self.flow.servers else set())

    def test_its_buttons_move_the_axis(self):
        flow = self.flow
        flow.press("600 rpm")
        flow.press("enable")
        flow.until("enabled", bool)
        for name, turns in (("to 2.5 turns", 2.5), ("to -0.5 turns", -0.5), ("to 2.5 turns", 2.5)):
            flow.press(name)
            flow.until("position_actual", lambda shown, turns=turns: abs(shown - turns) < 0.001)
            self.axis(1).until(axis_state=STANDSTILL)
        flow.press("quick stop")
        flow.until("stop_latched", bool)
        flow.press_in_vain("to -0.5 turns")
        flow.press("disable")
        flow.press("enable")
        flow.until("stop_latched", lambda shown: not shown)
        self.sim.ask("fault lift/1 2601 0x0020")
        flow.until("error_code", lambda shown: shown == 0x3210)
        self.sim.ask("clear lift/1 2601 0x0020")
        flow.press("fault reset")
        flow.until("error_code", lambda shown: shown == 0)
        flow.press("disable")
        self.until_it_stands_without_torque()


class NodeRedDies(OfTheFlow):
    def test_its_motor_is_stopped(self):
        flow = self.flow
        flow.press("600 rpm", {"value": [0, SLOW], "fc": 16, "unitid": 1, "address": 148, "quantity": 2})
        flow.press("enable")
        flow.press("to 2.5 turns")
        self.until_it_turns()
        flow.dies()
        self.axis(1).until_input("stop_latched")
        until("it stands", lambda: self.speed() == 0 and self.speed() == 0)
        self.assertLess(self.position(), 2.4)


if __name__ == "__main__":
    main()
