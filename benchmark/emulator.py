"""A ROS master and an emulator of a measurement's own."""
import contextlib
import os
import signal
import socket
import subprocess
import time
import xmlrpc.client
from pathlib import Path

DATA = Path(__file__).resolve().parent.parent / 'docs/data'
PATIENCE_S = 30.0


def binary(name):
    return subprocess.check_output(['catkin_find', '--first-only', '--libexec', 'afm_emulator', name],
                                   text=True).strip()


@contextlib.contextmanager
def master():
    """Its proxy. ROS_MASTER_URI names it, too."""
    with socket.socket() as free:
        free.bind(('localhost', 0))
        port = free.getsockname()[1]
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % port
    process, end = subprocess.Popen(['rosmaster', '--core', '-p', str(port)]), time.monotonic() + PATIENCE_S
    server = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])
    try:
        while True:
            with contextlib.suppress(OSError):
                server.getPid('benchmark')
                break
            if time.monotonic() > end:
                raise SystemExit('the master does not answer')
            time.sleep(0.1)
        yield server
    finally:
        process.kill()


@contextlib.contextmanager
def emulator(server, parameters):
    """Its process, interrupted at the end."""
    server.setParam('benchmark', '/afm', parameters)
    process = subprocess.Popen([binary('emulator_node'), '__name:=afm'])
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


def write_table(path, lines):
    path.write_text('\n'.join(lines) + '\n')
    print('\n'.join(lines))
