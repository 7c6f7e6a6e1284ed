# SPDX-License-Identifier: Apache-2.0
"""The stories of tests/integration/node_red_test.py with Node-RED itself in place of what stands for it there: tests/node_red/run calls it."""
import json
import os
import signal
import sys
import urllib.request

sys.path.insert(0, f"{sys.argv[3]}/tests/integration")
from examples_stage import EXAMPLES, PROGRAMS, main  # noqa: E402
from node_red_test import NodeRed, NodeRedDies  # noqa: E402
from processes import NEVER, Program, until  # noqa: E402
from stage import PORTS, SOURCE  # noqa: E402

KEPT = os.environ["AXISGATE_NODE_RED"]
SETTINGS = "module.exports = {uiHost: '127.0.0.1', nodesDir: '%s/node_modules/node-red-contrib-modbus', logging: {console: {level: 'info'}}};\n"


class RealFlow:
    """Node-RED, without a browser: buttons are pressed as its editor does it, and what its debug nodes show is heard."""

    def __init__(self, story, gateway_port):
        self.port = PORTS.free()
        with open(f"{EXAMPLES}/node-red/flow.json", encoding="utf-8") as file:
            nodes = json.load(file)
        for node in nodes:
            if node["type"] == "modbus-client":
                node["tcpPort"] = str(gateway_port)  # the one thing that a user changes as well
        self.nodes = {node["id"]: node for node in nodes}
        self.servers = [name for name, node in self.nodes.items() if node["type"] == "modbus-client"]
        home = story.path("node-red")
        os.makedirs(home)
        with open(f"{home}/settings.js", "w", encoding="utf-8") as file:
            file.write(SETTINGS % KEPT)
        with open(f"{home}/flow.json", "w", encoding="utf-8") as file:
            json.dump(nodes, file)
        self.program = story.keep(Program("Node-RED", ["node", f"{KEPT}/node_modules/node-red/red.js", "--userDir", home, "--port",
                                                       str(self.port), f"{home}/flow.json"], cwd=home))
        self.program.wait_for("Started flows")
        self.heard = story.keep(Program("what it shows", ["node", f"{SOURCE}/tests/node_red/shown.js", str(self.port)]))
        self.heard.wait_for("^subscribed")

    def named(self, kind, name):
        return next(node for node in self.nodes.values() if node["type"] == kind and node["name"] == name)

    def press(self, name, payload=None):
        """`payload`: in place of what the button sends."""
        body = {"__user_inject_props__": [{"p": "payload", "v": json.dumps(payload), "vt": "json"}]} if payload else {}
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}/inject/{self.named('inject', name)['id']}", json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=NEVER) as answer:
            assert answer.status == 200, answer.status

    def press_in_vain(self, name):
        """The node's own error."""
        before = len(self.program.found(r"\[error\]"))
        self.press(name)
        until("Node-RED tells that it was refused", lambda: len(self.program.found(r"\[error\]")) > before)

    def dies(self):
        self.program.send(signal.SIGKILL)

    def shown(self, name):
        for line in reversed(self.heard.lines):
            told = json.loads(line) if line.startswith("{") else {}
            if told.get("name") == name:
                return json.loads(told["msg"])
        return None

    def until(self, name, look):
        until(f"{name} is shown", lambda: (value := self.shown(name)) is not None and look(value))


def started(story):
    flow = RealFlow(story, story.ports[PROGRAMS])
    until("it reads the axis", lambda: flow.shown("position_actual") is not None)  # a person presses nothing before
    story.client = story.connect()  # Node-RED may have taken longer to start than a silent client is kept
    return flow


class RealNodeRed(NodeRed):
    started = started


class RealNodeRedDies(NodeRedDies):
    started = started


del NodeRed, NodeRedDies  # unittest would run what is merely imported

if __name__ == "__main__":
    main()
