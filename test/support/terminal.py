"""What a program shows where its stderr is a terminal."""
import os
import pty
import subprocess


def run_on_a_terminal(command):
    """(exit code, all that it showed). One read of a terminal may give less than was written to it."""
    screen, terminal = pty.openpty()
    try:
        program = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        shown = b''.join(iter(lambda: read(screen), b''))
        return program.wait(), shown.decode()
    finally:
        os.close(screen)


def read(screen):
    try:
        return os.read(screen, 1 << 16)
    except OSError:  # Linux: the last program has closed it
        return b''
