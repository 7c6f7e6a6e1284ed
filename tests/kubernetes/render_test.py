# SPDX-License-Identifier: Apache-2.0
"""Ten cells as deploy/kubernetes/render prints them: what the objects promise, and their command lines, started.

render_test.py AXISGATE AXISGATE_SIM SOURCE_FOLDER [unittest's arguments]
"""
import json
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "integration"))

from processes import NEVER, Program, until  # noqa: E402
from stage import AXISGATE, PORTS, SOURCE, Story, drive, main  # noqa: E402

RENDER = f"{SOURCE}/deploy/kubernetes/render"
CELLS = 10


def rendered(path):
    done = subprocess.run(["/usr/bin/python3", RENDER, path], capture_output=True, text=True, timeout=NEVER, check=False)
    return done.returncode, done.stdout, done.stderr


def write(path, value):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(value, file)


class Cells(Story):
    """Two on each node, each with a serial line of its own."""

    def setUp(self):
        super().setUp()
        self.cells = [self.cell(number) for number in range(1, CELLS + 1)]
        self.top = {"namespace": "axisgate", "image": "localhost/axisgate-dds:1", "cells": self.cells,
                    "discovery": {"image": "localhost/axisgate-discovery:1", "cluster_ip": "10.96.118.11"}}

    def cell(self, number):
        axis = drive("jd", 1, 1, name=f"axis-of-{number}")
        write(self.path(f"{number}.json"), {
            "modbus_tcp": [{"listen": "0.0.0.0:1502", "allow": [{"from": "127.0.0.1", "role": "viewer"}, {"from": "10.0.0.0/8", "role": "operator"}]}],
            "buses": [{"name": "line", "adapter": "kinco-serial", "device": "/dev/axisgate/line", "rs485": "off", "timeout_ms": 1000, "drives": [axis]}]})
        return {"name": f"cell-{number}", "node": f"edge-{(number + 1) // 2}", "configuration": f"{number}.json",
                "devices": {"line": f"/dev/serial/by-id/usb-adapter-{number}"}}

    def render(self):
        write(self.path("cells.json"), self.top)
        code, out, complaint = rendered(self.path("cells.json"))
        self.assertEqual(code, 0, complaint)
        return json.loads(out)["items"]

    def of_kind(self, kind):
        return [item for item in self.items if item["kind"] == kind]

    def change(self, number, edit):
        """The configuration of a cell."""
        with open(self.path(f"{number}.json"), encoding="utf-8") as file:
            config = json.load(file)
        edit(config)
        write(self.path(f"{number}.json"), config)

    def refused(self, *words):
        write(self.path("cells.json"), self.top)
        code, out, complaint = rendered(self.path("cells.json"))
        self.assertEqual((code, out), (1, ""), complaint)
        for word in words:
            self.assertIn(word, complaint)

    def test_each_cell_has_one_gateway_with_its_device_and_no_right_beside(self):
        self.items = self.render()
        sets = self.of_kind("StatefulSet")
        self.assertEqual([item["metadata"]["name"] for item in sets], [cell["name"] for cell in self.cells])
        granted = []
        for item, cell in zip(sets, self.cells):
            spec, pod = item["spec"], item["spec"]["template"]["spec"]
            self.assertEqual((spec["replicas"], spec["updateStrategy"]), (1, {"type": "OnDelete"}))
            self.assertEqual(pod["nodeSelector"], {"kubernetes.io/hostname": cell["node"]})
            self.assertTrue(pod["securityContext"]["runAsNonRoot"])
            container, = pod["containers"]
            self.assertEqual(container["securityContext"],
                             {"allowPrivilegeEscalation": False, "readOnlyRootFilesystem": True, "capabilities": {"drop": ["ALL"]}})
            self.assertFalse(pod.get("hostNetwork") or any("hostPath" in volume for volume in pod["volumes"]))
            granted += [name for name, count in container["resources"]["limits"].items() if "/" in name and count == "1"]
            self.assertFalse("annotations" in item["metadata"] or "annotations" in spec["template"]["metadata"])  # no metrics yet
        offered = [json.loads(word.partition("=")[2]) for word in self.of_kind("DaemonSet")[0]["spec"]["template"]["spec"]["containers"][0]["args"]
                   if word.startswith("--device=")]
        self.assertEqual(granted, [f"axisgate.dev/{device['name']}" for device in offered])
        self.assertEqual([group["count"] for device in offered for group in device["groups"]], [1] * CELLS)
        self.assertEqual(len(self.of_kind("PodDisruptionBudget")), CELLS)
        self.assertEqual({item["spec"]["maxUnavailable"] for item in self.of_kind("PodDisruptionBudget")}, {0})

    def test_every_selector_finds_its_own_pods_and_no_others(self):
        self.items = self.render()
        pods = {item["metadata"]["name"]: item["spec"]["template"]["metadata"]["labels"]
                for item in self.items if item["kind"] in ("StatefulSet", "Deployment", "DaemonSet")}
        for item in self.items:
            selector = item.get("spec", {}).get("selector", {})
            wanted = selector.get("matchLabels", selector)
            if wanted:
                found = [name for name, labels in pods.items() if wanted.items() <= labels.items()]
                self.assertEqual(found, [item["metadata"]["name"]], item["kind"])

    def test_their_command_lines_run_and_their_probes_tell_how_they_are(self):
        self.items = self.render()
        # What the objects name, and what stands for it on this machine.
        self.simulate({f"line{number}": "jd@1" for number in range(1, CELLS + 1)})
        gateways = []
        maps = {item["metadata"]["name"]: item["data"] for item in self.of_kind("ConfigMap")}
        for number, item in enumerate(self.of_kind("StatefulSet"), 1):
            pod = item["spec"]["template"]["spec"]
            container, = pod["containers"]
            volumes = {volume["name"]: volume["configMap"]["name"] for volume in pod["volumes"] if "configMap" in volume}
            mount, = (mount for mount in container["volumeMounts"] if mount["name"] in volumes)
            folder, port = self.path(item["metadata"]["name"]), PORTS.free()
            os.mkdir(folder)
            for name, text in maps[volumes[mount["name"]]].items():
                with open(f"{folder}/{name}", "w", encoding="utf-8") as file:
                    file.write(text.replace("/dev/axisgate/line", self.path(f"line{number}")).replace("0.0.0.0:1502", f"127.0.0.1:{port}"))
            here = {mount["mountPath"]: folder, "127.0.0.1:1502": f"127.0.0.1:{port}", "/usr/bin/axisgate": AXISGATE}
            words = [self.replaced(word, here) for word in container["args"]]
            checked = self.command_line("check", *words[1:])
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
            gateways.append((self.keep(Program(f"gateway of {item['metadata']['name']}", [AXISGATE, *words])),
                             [self.replaced(word, here) for word in container["livenessProbe"]["exec"]["command"]]))
        for gateway, probe in gateways:
            gateway.wait_for("listening on")
            until("its axis is online", lambda: "axes online 1 of 1" in self.probed(probe).stdout)
        gateway, probe = gateways[0]
        self.assertEqual(self.probed(probe).returncode, 0)
        self.sim.ask("unplug line1")
        until("its axis is gone", lambda: "axes online 0 of 1" in self.probed(probe).stdout)
        self.assertEqual(self.probed(probe).returncode, 0, "a dead drive is no reason to start the gateway anew")
        self.assertEqual(gateway.terminate(), 0)
        self.assertEqual(self.probed(probe).returncode, 1)
        for other, words in gateways[1:]:
            self.assertEqual(self.probed(words).returncode, 0, other.name)

    def replaced(self, word, here):
        for there, local in here.items():
            word = word.replace(there, local)
        return word

    def probed(self, words):
        return subprocess.run(words, capture_output=True, text=True, timeout=NEVER, check=False, stdin=subprocess.DEVNULL)

    def test_what_is_shipped_is_rendered_and_its_configurations_are_good(self):
        code, out, complaint = rendered(f"{SOURCE}/deploy/kubernetes/cells.json")
        self.assertEqual(code, 0, complaint)
        self.items = json.loads(out)["items"]
        for item in self.of_kind("ConfigMap"):
            path = self.path(f"{item['metadata']['name']}.json")
            with open(path, "w", encoding="utf-8") as file:
                file.write(item["data"]["gateway.json"])
            checked = self.command_line("check", path)
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        self.assertEqual(len(self.of_kind("NetworkAttachmentDefinition")), 1)

    def test_what_would_be_wrong_in_the_cluster_is_refused_with_its_place(self):
        self.cells[3]["devices"]["line"] = self.cells[2]["devices"]["line"]
        self.refused("/cells/3: ", "/dev/serial/by-id/usb-adapter-3 of node edge-2 is the bus of cell-3")
        self.cells[3] = self.cell(4)
        self.cells[3]["name"] = "cell-1"
        self.refused("/cells/3: 'cell-1' is the name of another cell")
        self.cells[3]["name"] = "Cell_4"
        self.refused("/cells/3/name: 'Cell_4' is no name for Kubernetes")
        self.cells[3] = {**self.cell(4), "nodes": 1}
        self.refused("/cells/3/nodes: no such key")
        self.cells[3] = {**self.cell(4), "devices": {"other": "/dev/ttyUSB0"}}
        self.refused("4.json: /buses/0/device: '/dev/axisgate/line' is none of the cell's devices, which are /dev/axisgate/other")
        self.cells[3] = {**self.cell(4), "can": ["can0"]}
        self.refused("/cells/3: 'can0' is granted, and no bus of")
        self.cells[3] = self.cell(4)
        edits = {
            "4.json: /modbus_tcp/0/allow: add": lambda config: config["modbus_tcp"][0]["allow"].pop(0),
            "4.json: /modbus_tcp: one listener must be": lambda config: config["modbus_tcp"][0].update(listen="0.0.0.0:502"),
            "4.json: /dds/discovery_servers: name the server": lambda config: config.update(dds={}),
        }
        for words, edit in edits.items():
            self.cells[3] = self.cell(4)
            self.change(4, edit)
            self.refused(words)
        with open(self.path("4.json"), "w", encoding="utf-8") as file:
            file.write("{")
        self.refused("4.json: no JSON")

    def test_comments_and_strings_that_look_like_them_are_told_apart(self):
        self.change(1, lambda config: config["buses"][0].update(name="a//b"))
        with open(self.path("1.json"), encoding="utf-8") as file:
            text = "// the first\n" + file.read() + "/* the end */\n"
        with open(self.path("1.json"), "w", encoding="utf-8") as file:
            file.write(text)
        self.items = self.render()
        self.assertEqual(self.of_kind("ConfigMap")[0]["data"]["gateway.json"], text)


if __name__ == "__main__":
    main()
