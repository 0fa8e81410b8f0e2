"""What scripts/run starts listens on loopback only."""
import contextlib
import os
import signal
from pathlib import Path

from emulator_under_test import SHARE, NodeTest, Process, find
from own_master import free_port
from topics import wait_until

LOOPBACK = ('0100007F', '00000000000000000000000001000000')  # 127.0.0.1 and ::1 as the kernel writes them
LISTENING = '0A'


def addresses_by_process(marker):
    """name of a process: addresses that it listens on; of all processes with this in their environment."""
    rows = [line.split() for table in Path('/proc/net').glob('tcp*') for line in table.read_text().splitlines()[1:]]
    known = {'socket:[%s]' % row[9]: row[1].split(':')[0] for row in rows if row[3] == LISTENING}
    found = {}
    for process in Path('/proc').glob('[0-9]*'):
        with contextlib.suppress(OSError):  # of another user, or it has ended
            if marker in (process / 'environ').read_bytes():
                sockets = [os.readlink(str(link)) for link in (process / 'fd').iterdir()]
                name = (process / 'comm').read_text().strip()
                found.setdefault(name, []).extend(known[s] for s in sockets if s in known)
    return found


class Loopback(NodeTest):
    def test_run_listens_on_loopback_only(self):
        """In a path with a space too."""
        devel = Path(find('emulator_node')).parents[2]
        environment = {name: value for name, value in os.environ.items() if name not in ('ROS_IP', 'ROS_HOSTNAME')}
        master = 'http://localhost:%d' % free_port()
        spaced = Path(self.temporary_directory()) / 'a b'
        spaced.symlink_to(devel.parent)
        environment.update(AFM_BUILD_DIR=str(spaced), ROS_MASTER_URI=master)
        command = ('source "$0/scripts/environment.bash"; listen_on_loopback_only; '
                   'exec roslaunch afm_emulator emulator.launch')
        launch = self.start(Process(['bash', '-c', command, str(SHARE)], env=environment, start_new_session=True))
        self.addCleanup(launch.stop, signal.SIGINT)
        wanted = {'emulator_node': 2, 'rosout': 2, 'rosmaster': 1, 'roslaunch': 1}

        def all_listen():
            found = addresses_by_process(master.encode())
            return found if all(len(found.get(name, ())) >= n for name, n in wanted.items()) else None
        found = wait_until(all_listen, 'master, rosout and emulator listen')
        for name, addresses in found.items():
            self.assertTrue(set(addresses) <= set(LOOPBACK), (name, addresses))
