"""What scripts/run starts listens on loopback only."""
import os
import signal
import subprocess
from pathlib import Path

import roslib.packages

from emulator_under_test import PACKAGE, NodeTest, Process
from own_master import free_port
from topics import wait_until

LOOPBACK = ('0100007F', '00000000000000000000000001000000')  # 127.0.0.1 and ::1 as the kernel writes them
LISTENING = '0A'


def listeners():
    """inode: address, of all sockets that listen."""
    found = {}
    for table in ('/proc/net/tcp', '/proc/net/tcp6'):
        if os.path.exists(table):
            for line in Path(table).read_text().splitlines()[1:]:
                fields = line.split()
                if fields[3] == LISTENING:
                    found[fields[9]] = fields[1].split(':')[0]
    return found


def sockets_of(pid):
    try:
        links = list(Path('/proc/%s/fd' % pid).iterdir())
    except OSError:  # it has ended
        return
    for link in links:
        try:
            target = os.readlink(str(link))
        except OSError:
            continue
        if target.startswith('socket:['):
            yield target[len('socket:['):-1]


def addresses_of_family(root):
    """name of a process: addresses that it listens on; of a process and its children and theirs."""
    table = subprocess.run(['ps', '-e', '-o', 'pid=,ppid=,comm='], stdout=subprocess.PIPE, universal_newlines=True)
    rows = [line.split(None, 2) for line in table.stdout.splitlines()]
    family, known, found = {str(root)}, listeners(), {}
    while True:
        more = {pid for pid, parent, _ in rows if parent in family} - family
        if not more:
            break
        family |= more
    for pid, _, name in rows:
        if pid in family and os.path.exists('/proc/%s/fd' % pid):
            found.setdefault(name, []).extend(known[i] for i in sockets_of(pid) if i in known)
    return found


class Loopback(NodeTest):
    def test_run_listens_on_loopback_only(self):
        package = Path(roslib.packages.get_pkg_dir(PACKAGE))
        devel = Path(roslib.packages.find_node(PACKAGE, 'emulator_node')[0]).parents[2]
        environment = {name: value for name, value in os.environ.items() if name not in ('ROS_IP', 'ROS_HOSTNAME')}
        environment.update(AFM_BUILD_DIR=str(devel.parent), ROS_MASTER_URI='http://localhost:%d' % free_port())
        command = ('source "$0/scripts/environment.bash"; listen_on_loopback_only; '
                   'exec roslaunch afm_emulator emulator.launch')
        launch = self.start(Process(['bash', '-c', command, str(package)], env=environment, start_new_session=True))
        self.addCleanup(launch.stop, signal.SIGINT)
        wanted = {'emulator_node': 2, 'rosout': 2, 'rosmaster': 1, 'roslaunch': 1}

        def all_listen():
            found = addresses_of_family(launch.child.pid)
            return found if all(len(found.get(name, ())) >= n for name, n in wanted.items()) else None
        found = wait_until(all_listen, 'master, rosout and emulator listen')
        for name, addresses in found.items():
            self.assertTrue(set(addresses) <= set(LOOPBACK), (name, addresses))
