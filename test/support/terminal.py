"""What a program shows where its stderr is a terminal."""
import os
import pty
import subprocess
import threading


def run_on_a_terminal(command, limit_s=120.0):
    """(exit code, all that it showed). One read of a terminal may give less than was written to it."""
    screen, terminal = pty.openpty()
    try:
        program = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        limit = threading.Timer(limit_s, program.kill)
        limit.start()
        shown = b''.join(iter(lambda: read(screen), b''))
        return program.wait(), shown.decode()
    finally:
        limit.cancel()
        os.close(screen)


def read(screen):
    try:
        return os.read(screen, 1 << 16)
    except OSError:  # Linux: the last program has closed it
        return b''
