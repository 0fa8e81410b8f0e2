"""A subscriber that speaks ROS's protocol over a bare socket, so that a test decides whether and how it reads."""
import select
import socket
import struct
import threading
import xmlrpc.client

import rospy
from rosgraph.network import write_ros_handshake_header

from topics import NAMESPACE, TOPICS


class BareSubscriber:
    def __init__(self, name, caller='/bare', master=None, kind=None):
        _, _, node = master.lookupNode(caller, NAMESPACE) if master else rospy.get_master().lookupNode(NAMESPACE)
        topic = name if name.startswith('/') else NAMESPACE + '/' + name
        code, text, (_, host, port) = xmlrpc.client.ServerProxy(node).requestTopic(caller, topic, [['TCPROS']])
        assert code == 1, text
        # before it connects, so that the sender learns of a small window
        self.socket = socket.socket()
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        self.socket.settimeout(15.0)
        self.socket.connect((host, port))
        self.kind = kind or TOPICS[name]
        write_ros_handshake_header(self.socket, {'callerid': caller, 'topic': topic, 'type': self.kind._type,
                                                 'md5sum': self.kind._md5sum, 'tcp_nodelay': '1'})
        self.read(struct.unpack('<I', self.read(4))[0])

    def read(self, size):
        data = b''
        while len(data) < size:
            part = self.socket.recv(size - len(data))
            assert part, 'the emulator has closed the connection'
            data += part
        return data

    def read_message(self):
        """A message of the topic, decoded."""
        size, = struct.unpack('<I', self.read(4))
        return self.kind().deserialize(self.read(size))

    def read_half_a_message(self):
        size, = struct.unpack('<I', self.read(4))
        return self.read(size // 2)

    def die(self):
        """As the kernel closes the socket of a process that is killed with data unread."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        self.socket.close()


class Drain:
    """Reads many subscribers' data and throws it away."""

    def __init__(self, subscribers):
        self.sockets = [subscriber.socket for subscriber in subscribers]
        self.bytes = {s: 0 for s in self.sockets}
        self._stopping = False
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self):
        while not self._stopping:
            for ready in select.select(self.sockets, [], [], 0.1)[0]:
                self.bytes[ready] += len(ready.recv(1 << 18))

    def stop(self):
        self._stopping = True
        self._thread.join()
        for s in self.sockets:
            s.close()
