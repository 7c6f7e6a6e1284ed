# SPDX-License-Identifier: Apache-2.0
"""Many clients at once: limits, roles and deaf ones hurt nobody else. More of it is told over real sockets by tests/unit/modbus_server."""
import socket
import struct

from modbus import CONTINUOUS, NO_FUNCTION, Axis, Client, Closed
from processes import NEVER, until
from stage import Story, main


def read_request(number, address, count):
    return struct.pack(">HHHBBHH", number, 0, 6, 1, 3, address, count)


class Limits(Story):
    """What others do to the gateway; meanwhile somebody's motor runs, and he can stop it."""

    def set_running(self, axis):
        axis.set(profile_acceleration=30000, profile_deceleration=30000, target_velocity=100000)
        axis.command("enable")
        axis.command("run_velocity")
        self.assert_runs()

    def assert_runs(self):
        before = self.sim.object("lift/1", "6063.00")
        until("the motor turns on", lambda: self.sim.object("lift/1", "6063.00") > before)

    def assert_obeys(self, axis):
        self.assert_runs()
        self.assertEqual(axis.get("axis_state"), CONTINUOUS)
        axis.command("quick_stop")
        until("the motor stands", lambda: self.sim.object("lift/1", "606C.00") == 0)
        axis.until_input("stop_latched")

    def assert_closed(self, client):
        with self.assertRaises(Closed):
            client.registers(0)

    def test_one_client_too_many_is_closed_and_the_others_stay(self):
        self.simulate()
        for option in ("max_clients", "max_clients_per_address"):
            with self.subTest(option):
                self.configure([self.listener(**{option: 3})])
                self.run_gateway()
                clients = [self.connect() for _ in range(3)]
                self.client = clients[2]
                self.until_online()
                for client in clients:
                    client.registers(0)
                self.set_running(self.axis(1))
                self.assert_closed(self.connect())
                self.gateway.wait_for("refused")
                for client in clients:
                    self.assertEqual(client.gateway()["map_version"], 1)
                self.assert_obeys(self.axis(1))
                clients[0].close()
                until("a place is free", self.is_served)
                self.gateway.terminate()

    def is_served(self):
        client = Client(self.ports[0])
        try:
            return client.registers(0)
        except Closed:
            return None
        finally:
            client.close()

    def test_a_client_that_never_reads_its_answers_harms_nobody(self):
        self.start()
        self.set_running(self.axis(1))
        with socket.create_connection(("127.0.0.1", self.ports[0]), timeout=NEVER) as deaf:
            deaf.setblocking(False)

            def look():
                self.assertEqual(self.client.gateway()["axes_online"], 2)
                try:
                    for number in range(1000):
                        deaf.send(read_request(number, 100, 90))
                except BlockingIOError:
                    pass
                except (BrokenPipeError, ConnectionResetError):
                    return True
                return False

            until("it is cut off", look)
        self.assert_obeys(self.axis(1))


class AllowList(Story):
    def test_a_viewer_reads_and_writes_nothing(self):
        self.start([self.listener(), self.listener(allow=[{"from": "127.0.0.0/8", "role": "viewer"}])])
        axis = Axis(self.connect(1), 1)
        self.assertEqual(axis.client.gateway()["role"], 1)
        self.assertEqual(axis.get("link_state"), 2)
        writes = self.sim.writes("lift/1")
        for work in (lambda: axis.set(target_velocity=5), lambda: axis.set(controlword=6), lambda: axis.command("enable"),
                     lambda: axis.coil("quick_stop"), lambda: axis.set(position_limit_min=5), lambda: axis.set(position_actual=5)):
            with self.refused(NO_FUNCTION):
                work()
        self.assertEqual(self.sim.writes("lift/1"), writes)
        axis.client.write(8, 77)  # the heartbeat is everybody's
        axis.set(object_index=0x6041, object_subindex=0, object_size=2)
        axis.set(object_request=1)
        axis.until(object_status=2)
        with self.refused(NO_FUNCTION):
            axis.set(object_request=2)


if __name__ == "__main__":
    main()
