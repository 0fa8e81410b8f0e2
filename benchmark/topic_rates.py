#!/usr/bin/python3
"""What each topic carries: messages and bytes a second, at the default rates and at the greatest ones. Starts a master
and an emulator of its own for each. Prints the table of docs/interface.md.

usage: topic_rates.py [--seconds S]     (default: 10)"""
import time

from emulator import emulator, option, own_master

# eta = 3.4 of mica, the chaotic motion of the paper
SCENE = {'drag_velocity': 1.1255437575458838e-05, 'publish_clock': True}
SETTINGS = {'default': {}, 'greatest': {'batch_rate_hz': 1000.0, 'sample_rate_hz': 1e6}}
TOPICS = ('deflection', 'impacts', 'friction', 'status', 'applied', 'configuration', 'snapshot')


def listen(seconds):
    """{topic: [bytes of each message]} of so many seconds of wall time, what is latched before them included."""
    import rospy
    if not rospy.core.is_initialized():
        rospy.init_node('topic_rates', anonymous=True, disable_rostime=True)
    received = {}

    def keep(message, name):
        received.setdefault(name, []).append(len(message._buff))

    subscribers = [rospy.Subscriber(name, rospy.AnyMsg, keep, name, tcp_nodelay=True, buff_size=1 << 22)
                   for name in ['/afm/' + topic for topic in TOPICS] + ['/clock', '/diagnostics']]
    end = time.monotonic() + 30.0
    while len(received.get('/afm/deflection', ())) < 10 and time.monotonic() < end:
        time.sleep(0.01)
    latched = {name: sizes[:1] for name, sizes in received.items() if name.rsplit('/')[-1] in TOPICS[4:]}
    received.clear()
    begin = time.monotonic()
    time.sleep(seconds)
    elapsed, counted = time.monotonic() - begin, {name: list(sizes) for name, sizes in received.items()}
    for subscriber in subscribers:
        subscriber.unregister()
    return elapsed, counted, latched


def three_digits(number):
    return '%g' % float('%.3g' % number)


def rows(default, greatest):
    elapsed, counted, latched = default
    rates = {name: len(sizes) / elapsed for name, sizes in counted.items()}
    volume = {name: sum(sizes) / elapsed / 1e3 for name, sizes in counted.items()}
    at_most = {name: sum(sizes) / greatest[0] / 1e3 for name, sizes in greatest[1].items()}
    for name in sorted(counted, key=lambda name: -volume[name]):
        mean = sum(counted[name]) / len(counted[name])
        yield '`%s`,%s,%.0f,%s,%s' % (name, three_digits(rates[name]), mean, three_digits(volume[name]),
                                      three_digits(at_most.get(name, 0.0)))
    for name in sorted(latched):
        if name not in counted:
            yield '`%s`,when it changes,%d,,' % (name, latched[name][0])


def main():
    seconds, received = option(__doc__, 'seconds', 10.0), {}
    with own_master() as server:
        for name, settings in SETTINGS.items():
            with emulator(server, dict(SCENE, **settings)):
                received[name] = listen(seconds)
    print('topic,messages a second,bytes a message,kB/s,kB/s at 1 MHz of samples and 1000 batches a second')
    print('\n'.join(rows(received['default'], received['greatest'])))


if __name__ == '__main__':
    main()
