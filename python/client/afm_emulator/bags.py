"""The messages of emulators in a bag, as bytes: for whoever needs few of their fields, of very many messages."""
import collections

import rosbag
from afm_emulator import msg

# Without them rosbag makes classes from the definitions in the bag, which may be damaged.
rosbag.bag._message_types.update({kind._md5sum: kind for kind in vars(msg).values() if hasattr(kind, '_md5sum')})

# kind: of its type, such as Friction; node: that published it; of_type: class of its md5sum; stamp: time of the bag
Raw = collections.namedtuple('Raw', 'kind topic node data md5sum of_type stamp')


def why_unreadable(fault):
    """In words, of what rosbag raises: damaged bytes make it raise whatever they lead to."""
    if isinstance(fault, rosbag.bag.ROSBagUnindexedException):
        return 'not closed: rosbag reindex recovers what is in it (take a copy while it is written)'
    return str(fault) or type(fault).__name__


def read_raw(bag, kinds):
    """Those of these kinds, in the order of the bag."""
    types = ['afm_emulator/' + kind for kind in kinds]
    # rosbag record repeats latched messages without the name of their node: it is that of its namespace
    named = {c.topic.rpartition('/')[0]: c.header['callerid'] for c in bag._get_connections()
             if c.datatype.startswith('afm_emulator/') and 'callerid' in c.header}
    for topic, raw, stamp, header in bag.read_messages(
            raw=True, return_connection_header=True, connection_filter=lambda _, datatype, *__: datatype in types):
        node = header.get('callerid', named.get(topic.rpartition('/')[0], b''))
        yield Raw(raw[0].split('/')[1], topic, node.decode() if isinstance(node, bytes) else node, raw[1], raw[2],
                  raw[4], stamp)


def first_batch(path):
    """The emulator whose batch is the first, and when it came; without one, when the bag begins, 0 if it is empty."""
    with rosbag.Bag(str(path)) as bag:
        batch = next(read_raw(bag, ['Friction']), None)
        if batch:
            return batch.node, batch.stamp.to_sec()
        return '', bag.get_start_time() if bag.get_message_count() else 0.0


def in_order(paths):
    """Bags in the order of their batches: a shell may list the parts of a recording in another one."""
    if len(paths) < 2:  # the index of a long recording takes seconds to read
        return paths
    def begin(path):
        try:
            return first_batch(path)[1]
        except Exception:  # whoever reads it says why
            return 0.0
    return sorted(paths, key=begin)
