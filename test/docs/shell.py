"""A shell in which a user would paste commands: a copy of the tree, an empty home, devel/setup.bash sourced, a ROS
master."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / 'scripts'))
from own_master import free_port  # noqa: E402

PATIENCE = float(os.environ.get('AFM_PATIENCE', '1'))
DEADLINE_S = 120 * PATIENCE
# what commands read, and some write
COPIED = ('README.md', 'Snakefile', 'benchmark', 'config', 'docs', 'examples', 'scripts', 'test/data', 'test/node',
          'workflow')
PRELUDE = '''source "$0/setup.bash" || exit
until_interrupted() { %s/until_interrupted.py "$@"; }
set -eo pipefail
''' % Path(__file__).resolve().parent


def clean_environment(home, **more):
    """Nothing of the machine's own, no display among it."""
    return dict({'HOME': str(home), 'PATH': '/usr/bin:/bin:/usr/sbin:/sbin', 'LC_ALL': 'C.UTF-8',
                 'ROS_HOSTNAME': 'localhost', 'PYTHONUNBUFFERED': '1'}, **more)


class Shell:
    def __init__(self, root, build, prefix):
        self.prefix, self.emulator = prefix, None
        self.directory = Path(tempfile.mkdtemp(prefix='afm_documents_'))
        self.tree, self.home = self.directory / 'tree', self.directory / 'home'
        self.home.mkdir()
        for name in COPIED:
            copy = shutil.copytree if (root / name).is_dir() else shutil.copy
            (self.tree / name).parent.mkdir(parents=True, exist_ok=True)
            copy(str(root / name), str(self.tree / name))
        (self.tree / 'build').mkdir()
        (self.tree / 'build' / 'test').symlink_to(build / 'test')
        (self.tree / 'devel').symlink_to(prefix)
        # a master of its own for what starts an emulator of its own
        self.environment = clean_environment(self.home, AFM_ROOT=str(root),
                                             ROS_MASTER_URI='http://localhost:%d' % free_port())
        if prefix == build / 'devel':
            self.environment['AFM_BUILD_DIR'] = str(build)

    def start(self, text, **environment):
        return subprocess.Popen(['bash', '-c', PRELUDE + text, str(self.prefix)], cwd=str(self.tree),
                                env=dict(self.environment, **environment), stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                                start_new_session=True)

    def run(self, text, own_master=False):
        """The exit code and everything that was printed."""
        own = {'ROS_MASTER_URI': 'http://localhost:%d' % free_port()} if own_master else {}
        process = self.start(text, **own)
        try:
            return process.communicate(timeout=DEADLINE_S)[0], process.returncode
        except subprocess.TimeoutExpired:
            return self.stop(process) + '\n(not within %g s)' % DEADLINE_S, -1

    @staticmethod
    def stop(process):
        """What it has printed until then. SIGTERM first: scripts/run stops what it started."""
        os.killpg(process.pid, signal.SIGTERM)
        try:
            return process.communicate(timeout=30)[0]
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return process.communicate()[0]

    def start_emulator(self):
        port = self.environment['ROS_MASTER_URI'].rsplit(':', 1)[1]
        log = (self.directory / 'emulator.log').open('w')
        with log:
            self.emulator = subprocess.Popen(
                ['bash', '-c', PRELUDE + 'exec roslaunch -p %s afm_emulator emulator.launch record:=false' % port,
                 str(self.prefix)], env=self.environment, stdin=subprocess.DEVNULL, stdout=log,
                 stderr=subprocess.STDOUT,
                start_new_session=True)
        self.is_emulator_alive()

    def is_emulator_alive(self):
        """Whether a message of it comes, and its services are there; waits for both."""
        end = time.monotonic() + DEADLINE_S
        while time.monotonic() < end and self.emulator.poll() is None:
            answered = self.run('timeout 30 rostopic echo -n 1 /afm/status && rosservice type /afm/stop_recording')[1]
            if answered == 0:
                return True
        return False

    def close(self):
        if self.emulator and self.emulator.poll() is None:
            self.emulator.send_signal(signal.SIGINT)
            self.emulator.wait(timeout=DEADLINE_S)
        shutil.rmtree(str(self.directory))
