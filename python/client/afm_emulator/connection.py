"""A persistent connection to a service, with a time-out for every call. The ServiceProxy of rospy waits for an answer
without end, and does not connect again when the service has been restarted."""
import http.client
import io
import socket
import struct
import time
import xmlrpc.client

import rosgraph
import rospy
from rosgraph.network import decode_ros_handshake_header, write_ros_handshake_header

POLL_S = 0.05  # how soon a shutdown of this node ends a call
# of asking the master, and of connecting
FAULTS = (OSError, rosgraph.MasterException, http.client.HTTPException, xmlrpc.client.Error)


class Connection:
    """kind: class of the service; end: time.monotonic() until when it waits for the service.

    Whatever does not come in time raises a TimeoutError, a connection that ends a ConnectionError, a shutdown of this
    node a rospy.ROSInterruptException.
    """

    def __init__(self, name, kind, end):
        self._name, self._kind = name, kind
        self._socket = None
        while self._socket is None:
            try:
                self._socket = self._connect(end)
            except FAULTS as fault:  # not there yet, or its address is of a dead node
                if time.monotonic() > end:
                    raise TimeoutError(str(fault)) from fault
                self._check_shutdown()
                time.sleep(POLL_S)

    def _connect(self, end):
        host, port = rospy.core.parse_rosrpc_uri(rosgraph.Master(rospy.get_name()).lookupService(self._name))
        connected = socket.create_connection((host, port), min(1.0, max(POLL_S, end - time.monotonic())))
        try:
            connected.settimeout(POLL_S)
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            write_ros_handshake_header(connected, {'callerid': rospy.get_name(), 'service': self._name,
                                                   'md5sum': self._kind._md5sum, 'persistent': '1'})
            size = self._read(connected, 4, end)
            header = decode_ros_handshake_header(size + self._read(connected, *struct.unpack('<I', size), end))
            if 'error' in header:
                raise ConnectionError(header['error'])
        except BaseException:
            connected.close()
            raise
        return connected

    def call(self, request, end):
        """The answer, if it comes before time.monotonic() is `end`. After an exception the connection is of no use."""
        self._check_shutdown()
        data = io.BytesIO()
        request.serialize(data)
        self._socket.sendall(struct.pack('<I', data.tell()) + data.getvalue())
        succeeded, size = struct.unpack('<BI', self._read(self._socket, 5, end))
        body = self._read(self._socket, size, end)
        if not succeeded:
            raise ConnectionError(body.decode(errors='replace'))
        return self._kind._response_class().deserialize(body)

    def close(self):
        self._socket.close()

    def _read(self, connected, size, end):
        data = b''
        while len(data) < size:
            try:
                part = connected.recv(size - len(data))
            except socket.timeout:
                self._check_shutdown()
                if time.monotonic() > end:
                    raise TimeoutError('no answer') from None
                continue
            if not part:
                raise ConnectionResetError('the connection has ended')
            data += part
        return data

    @staticmethod
    def _check_shutdown():
        if rospy.is_shutdown():
            raise rospy.ROSInterruptException('shut down')
