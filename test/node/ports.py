"""Ports for masters of a test's own."""
import random
import socket


def free_port():
    """Below those that the system gives to whoever asks for any: nobody gets it before a master has it."""
    while True:
        port = random.randrange(20000, 32000)
        with socket.socket() as free:
            try:
                free.bind(('localhost', port))
                return port
            except OSError:
                continue
