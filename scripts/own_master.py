"""A ROS master of one's own, for measurements and tests."""
import contextlib
import os
import random
import socket
import subprocess
import time
import xmlrpc.client

PATIENCE_S = 30.0
STDERR = 2  # the standard output of a measurement is its table


def free_port():
    """Below those that the system gives to whoever asks for any: nobody gets it before a master has it."""
    while True:
        port = random.randrange(20000, 32000)
        with socket.socket() as free, contextlib.suppress(OSError):
            free.bind(('localhost', port))
            return port


@contextlib.contextmanager
def own_master():
    """Its proxy. ROS_MASTER_URI names it, too."""
    port = free_port()
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % port
    process = subprocess.Popen(['rosmaster', '--core', '-p', str(port)], stdout=STDERR)
    end = time.monotonic() + PATIENCE_S
    server = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])
    try:
        while True:
            with contextlib.suppress(OSError):
                server.getPid('own_master')
                break
            if process.poll() is not None or time.monotonic() > end:
                raise SystemExit('the ROS master does not start')
            time.sleep(0.05)
        yield server
    finally:
        process.kill()
        process.wait()
