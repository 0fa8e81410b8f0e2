"""The front panel: an instrument on the topics of an emulator. signals.py knows neither ROS nor Qt, link.py is all of
ROS, knobs.py and window.py are all of Qt."""
