# SPDX-License-Identifier: Apache-2.0
"""axisgate-web dies, stands still, or is not there: no drive and no Modbus client notices, and the page comes back."""
import http.client
import json
import os
import signal
import socket
from contextlib import suppress

from processes import NEVER, until
from stage import PORTS, Story, main

RPM = 1000  # of a register


class Page(Story):
    """A motor turns while something happens to the page."""

    def configure(self, listeners=None, buses=None, name="gateway.json"):
        config = super().configure(listeners, buses, name)
        self.page_port = PORTS.free()
        self.change(web={"listen": f"127.0.0.1:{self.page_port}"})
        return config

    def change(self, **sections):
        with open(self.config, encoding="utf-8") as file:
            config = json.load(file)
        for key, section in sections.items():
            config.pop(key, None)
            if section is not None:
                config[key] = section
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(config, file, indent=2)

    def process(self):
        """Of axisgate-web, a child of the gateway; None: there is none."""
        for pid in filter(str.isdigit, os.listdir("/proc")):
            with suppress(OSError, IndexError):
                with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
                    name, rest = file.read().rsplit(")", 1)
                if name.endswith("(axisgate-web") and rest.split()[1] == str(self.gateway.pid) and rest.split()[0] != "Z":
                    return int(pid)
        return None

    def get(self, path, port=None):
        connection = http.client.HTTPConnection("127.0.0.1", port or self.page_port, timeout=NEVER)
        self.addCleanup(connection.close)
        connection.request("GET", path)
        answer = connection.getresponse()
        return json.loads(answer.read())

    def answers(self, port=None):
        with suppress(OSError, http.client.HTTPException):
            return self.get("/api/v1/gateway", port).get("joined")
        return False

    def run_motor(self):
        self.start()
        until("the page", self.answers)
        axis = self.axis(1)
        axis.command("enable")
        axis.set(target_velocity=200 * RPM)
        axis.command("run_velocity")
        until("it turns", lambda: axis.get("velocity_actual") > 150 * RPM)

    def turns(self):
        return self.axis(1).get("velocity_actual") > 150 * RPM


class Disturbed(Page):
    def signal(self, number):
        pid = self.process()

        def go_on():
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)

        self.addCleanup(go_on)
        os.kill(pid, number)
        return pid

    def test_killed_it_is_back_and_nothing_else_has_changed(self):
        self.run_motor()
        before = self.signal(signal.SIGKILL)
        self.gateway.wait_for("axisgate-web was killed: signal 9")
        until("another one answers", lambda: self.process() not in (None, before) and self.answers())
        self.assertTrue(self.turns())
        programs = self.get("/api/v1/gateway")["programs"]
        self.assertEqual([each["restarts"] for each in programs if each["name"] == "axisgate-web"], [1])

    def test_standing_still_it_is_replaced(self):
        self.run_motor()
        before = self.signal(signal.SIGSTOP)
        self.gateway.wait_for("axisgate-web took nothing from the gateway for too long and was killed")
        until("another one answers", lambda: self.process() not in (None, before) and self.answers())
        self.assertTrue(self.turns())


class Ends(Page):
    def test_it_ends_with_the_gateway_and_frees_its_port(self):
        self.run_motor()
        pid = self.process()
        self.gateway.send(signal.SIGKILL)
        self.gateway.ended()
        until("its end", lambda: not os.path.exists(f"/proc/{pid}"))
        with socket.socket() as next_one:
            next_one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            next_one.bind(("127.0.0.1", self.page_port))

    def test_an_address_in_use_ends_the_page_alone(self):
        self.simulate()
        self.configure()
        with socket.socket() as holder:
            holder.bind(("127.0.0.1", self.page_port))
            holder.listen()
            self.run_gateway()
            self.gateway.wait_for("axisgate-web cannot listen on the address of `web`")
            self.client = self.connect()
            self.until_online()
        until("the page", self.answers)


class Reloaded(Page):
    def reload(self):
        done = self.command_line("reload", self.config)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_another_address_is_served_beside_a_motor_that_turns(self):
        self.run_motor()
        other = PORTS.free()
        self.change(web={"listen": f"127.0.0.1:{other}"})
        self.assertIn("web: changed", self.reload())
        until("the page at its new address", lambda: self.answers(other))
        self.assertFalse(self.answers())
        self.assertTrue(self.turns())
        self.change(web=None)
        self.assertIn("web: removed", self.reload())
        until("no page", lambda: self.process() is None)
        self.assertTrue(self.turns())
        self.change(web={"listen": f"127.0.0.1:{other}"})
        self.reload()
        until("the page again", lambda: self.answers(other))


if __name__ == "__main__":
    main()
