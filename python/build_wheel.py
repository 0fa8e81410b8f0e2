"""Builds the wheel of the module afm for pip (PEP 517): runs CMake without ROS and packs what it installs.

With AFM_WHEEL_BUILD in the environment it builds in that folder and leaves it, so that the next build is quick.
"""
import base64
import hashlib
import os
import re
import shlex
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NAME = 'afm_emulator'
METADATA = '''Metadata-Version: 2.1
Name: %s
Version: %s
Summary: An AFM tip as an impact oscillator over a sinusoidal surface, exact from impact to impact
License: BSD-3-Clause
Requires-Python: >=3.7
Requires-Dist: numpy
'''
WHEEL = 'Wheel-Version: 1.0\nGenerator: build_wheel\nRoot-Is-Purelib: false\nTag: %s\n'


def version():
    return re.search(r'<version>(.*)</version>', (ROOT / 'package.xml').read_text()).group(1)


def tag():
    python = 'cp%d%d' % sys.version_info[:2]
    abi = python + ('m' if sys.version_info < (3, 8) else '')
    return '%s-%s-%s' % (python, abi, re.sub(r'[-.]', '_', sysconfig.get_platform()))


NEEDED = 'afm_emulator: %s. The module needs a compiler, CMake, Boost, Eigen, pybind11 and the headers of Python. On Debian ' \
    'and Ubuntu scripts/install_dependencies --without-ros installs them all.'


def configure(build, *options):
    """Ends with a sentence where something is missing."""
    try:
        subprocess.check_call(['cmake', '-S', str(ROOT), '-B', str(build), '-DAFM_ROS=OFF', '-DAFM_DYNAMICS=ON',
                               '-DBUILD_TESTING=OFF', '-DCMAKE_BUILD_TYPE=Release', '-DAFM_PYTHON_DESTINATION=.',
                               '-DPYTHON_EXECUTABLE=' + sys.executable, '-DPython3_EXECUTABLE=' + sys.executable,
                               *shlex.split(os.environ.get('CMAKE_ARGS', '')), *options])
    except FileNotFoundError:
        sys.exit(NEEDED % 'cmake was not found')
    except subprocess.CalledProcessError:
        sys.exit(NEEDED % 'cmake could not configure the build; its reason is above')
    if '_afm' not in (Path(build) / 'python' / 'cmake_install.cmake').read_text():
        sys.exit(NEEDED % 'pybind11 or the headers of Python were not found')


def install(build, prefix):
    """The package `afm`, below the prefix."""
    configure(build)
    subprocess.check_call(['cmake', '--build', str(build), '--target', 'afm_python', '--parallel',
                           str(os.cpu_count() or 1)])
    subprocess.check_call(['cmake', '-DCMAKE_INSTALL_COMPONENT=python', '-DCMAKE_INSTALL_PREFIX=' + str(prefix), '-P',
                           str(Path(build) / 'python' / 'cmake_install.cmake')])


class Record:
    """Writes files into the archive and keeps the list of them that a wheel ends with."""

    def __init__(self, archive):
        self.archive, self.lines = archive, []

    def add(self, name, content):
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()
        self.archive.writestr(name, content)
        self.lines.append('%s,sha256=%s,%d\n' % (name, digest, len(content)))


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """The hook that pip calls: builds the wheel and returns its name."""
    name, info = '%s-%s-%s.whl' % (NAME, version(), tag()), '%s-%s.dist-info/' % (NAME, version())
    with tempfile.TemporaryDirectory() as scratch, zipfile.ZipFile(str(Path(wheel_directory) / name), 'w',
                                                                   zipfile.ZIP_DEFLATED) as archive:
        prefix = Path(scratch) / 'prefix'
        install(os.environ.get('AFM_WHEEL_BUILD', Path(scratch) / 'build'), prefix)
        record = Record(archive)
        for path in sorted(prefix.rglob('*')):
            if path.is_file():
                record.add(path.relative_to(prefix).as_posix(), path.read_bytes())
        record.add(info + 'METADATA', (METADATA % (NAME, version())).encode())
        record.add(info + 'WHEEL', (WHEEL % tag()).encode())
        archive.writestr(info + 'RECORD', ''.join(record.lines) + info + 'RECORD,,\n')
    return name
