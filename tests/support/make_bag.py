#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts a sequence in TUM's format into a recording of ROS, to test its readers with files that
the project's own writer did not make.

The ending of OUT tells the format: .mcap (ROS 2), .db3 (rosbag2, SQLite) or .bag (ROS 1, 2.0).
"""

import argparse
import bz2
import pathlib
import sqlite3
import struct

import cv2

TYPES = {"image": "Image", "compressed": "CompressedImage", "info": "CameraInfo"}


class Message:
    """The fields of a message, one after the other, in CDR or in the coding of ROS 1."""

    def __init__(self, ros1):
        self.ros1 = ros1
        self.parts = []
        self.size = 0

    def raw(self, data):
        self.parts.append(data)
        self.size += len(data)

    def put(self, kind, *numbers):
        size = struct.calcsize("<" + kind)
        for number in numbers:
            if not self.ros1:
                self.raw(bytes(-self.size % size))
            self.raw(struct.pack("<" + kind, number))

    def text(self, text):
        data = text.encode() + (b"" if self.ros1 else b"\0")
        self.put("I", len(data))
        self.raw(data)

    def data(self, data):
        self.put("I", len(data))
        self.raw(bytes(data))

    def header(self, stamp):
        seconds, fraction = stamp.split(".")
        if self.ros1:
            self.put("I", 0)
        self.put("I", int(seconds), int(fraction.ljust(9, "0")[:9]))
        self.text("camera")

    def bytes(self):
        return (b"" if self.ros1 else b"\0\1\0\0") + b"".join(self.parts)


def nanoseconds(stamp):
    seconds, fraction = stamp.split(".")
    return int(seconds) * 10**9 + int(fraction.ljust(9, "0")[:9])


def raw_image(ros1, stamp, path, form):
    flags = {"raw-grey": cv2.IMREAD_GRAYSCALE, "raw": cv2.IMREAD_COLOR, "depth": cv2.IMREAD_UNCHANGED}
    encodings = {"raw-grey": "mono8", "raw": "bgr8", "depth": "16UC1"}
    image = cv2.imread(str(path), flags[form] | cv2.IMREAD_IGNORE_ORIENTATION
                       if form != "depth" else flags[form])
    message = Message(ros1)
    message.header(stamp)
    message.put("I", image.shape[0], image.shape[1])
    message.text(encodings[form])
    message.put("B", 0)
    message.put("I", image.strides[0])
    message.data(image.tobytes())
    return message.bytes()


def compressed_image(ros1, stamp, path, is_depth):
    message = Message(ros1)
    message.header(stamp)
    kind = "jpeg" if path.suffix in (".jpg", ".jpeg") else "png"
    message.text("16UC1; compressedDepth png" if is_depth else f"bgr8; {kind} compressed bgr8")
    message.data((bytes(12) if is_depth else b"") + path.read_bytes())
    return message.bytes()


def camera_info(ros1, stamp, settings):
    camera = {}
    for line in settings.read_text(encoding="utf-8").splitlines():
        key, _, value = line.partition(":")
        if key.startswith("Camera."):
            camera[key[len("Camera."):].strip()] = value.split("#")[0].strip()
    number = lambda key, default=0.0: float(camera.get(key, default))
    message = Message(ros1)
    message.header(stamp)
    message.put("I", int(number("height", 480)), int(number("width", 640)))
    message.text("plumb_bob")
    message.put("I", 5)
    message.put("d", *(number(key) for key in ("k1", "k2", "p1", "p2", "k3")))
    matrix = [number("fx"), 0, number("cx"), 0, number("fy"), number("cy"), 0, 0, 1]
    message.put("d", *matrix, 1, 0, 0, 0, 1, 0, 0, 0, 1, *matrix[:3], 0, *matrix[3:6], 0,
                *matrix[6:], 0)
    message.put("I", *[0] * 6)
    message.put("B", 0)
    return message.bytes()


def read_list(path):
    if not path.exists():
        return []
    rows = (line.split() for line in path.read_text(encoding="utf-8").splitlines())
    return [(row[0], path.parent / row[1]) for row in rows if row and not row[0].startswith("#")]


def messages(options, ros1):
    """Yields (time in ns, topic, kind, bytes) in the order of time."""
    images = [(stamp, path, False) for stamp, path in read_list(options.sequence / "rgb.txt")]
    images += [(stamp, path, True) for stamp, path in read_list(options.sequence / "depth.txt")]
    for stamp, path, is_depth in sorted(images, key=lambda image: nanoseconds(image[0])):
        time = nanoseconds(stamp)
        topic = "/camera/depth/image" if is_depth else "/camera/rgb/image_color"
        if options.images == "files":
            form = "/compressedDepth" if is_depth else "/compressed"
            image = compressed_image(ros1, stamp, path, is_depth)
            yield time, topic + form, "compressed", image
            if not is_depth and options.second_topic:
                yield time, options.second_topic, "compressed", image
        else:
            form = "depth" if is_depth else options.images
            yield time, topic, "image", raw_image(ros1, stamp, path, form)
        if not is_depth and options.settings:
            yield (time, "/camera/rgb/camera_info", "info",
                   camera_info(ros1, stamp, options.settings))


def compress(name, data):
    if name == "bz2":
        return bz2.compress(data, 1)
    if name == "lz4":
        import lz4.frame  # pylint: disable=import-outside-toplevel
        return lz4.frame.compress(data)
    return data


def length_first(data):
    return struct.pack("<I", len(data)) + data


def write_mcap(options):
    def record(kind, content):
        return struct.pack("<BQ", kind, len(content)) + content

    def text(value):
        return length_first(value.encode())

    topics = {}
    with options.out.open("wb") as file:
        file.write(b"\x89MCAP0\r\n" + record(1, text("ros2") + text("make_bag.py")))
        for number, (time, topic, kind, data) in enumerate(messages(options, False)):
            chunk = b""
            if topic not in topics:
                topics[topic] = len(topics) + 1
                ids = struct.pack("<H", topics[topic])
                chunk += record(3, ids + text("sensor_msgs/msg/" + TYPES[kind]) + text("ros2msg")
                                + length_first(b""))
                chunk += record(4, ids + ids + text(topic) + text("cdr") + length_first(b""))
            chunk += record(5, struct.pack("<HIQQ", topics[topic], number, time, time) + data)
            if options.compression == "none":
                file.write(chunk)
            else:
                packed = compress(options.compression, chunk)
                file.write(record(6, struct.pack("<QQQI", time, time, len(chunk), 0)
                                  + text(options.compression) + struct.pack("<Q", len(packed))
                                  + packed))
        file.write(record(15, bytes(4)) + record(2, bytes(20)) + b"\x89MCAP0\r\n")


def write_sqlite(options):
    options.out.unlink(missing_ok=True)
    database = sqlite3.connect(options.out)
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT "
                     "NULL, serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    topics = {}
    for time, topic, kind, data in messages(options, False):
        if topic not in topics:
            topics[topic] = len(topics) + 1
            database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')",
                             (topics[topic], topic, "sensor_msgs/msg/" + TYPES[kind]))
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                         (topics[topic], time, data))
    database.commit()
    database.close()


def write_ros1(options):
    def record(fields, data):
        header = b"".join(length_first(name.encode() + b"=" + value)
                          for name, value in fields.items())
        return length_first(header) + length_first(data)

    connections = {}
    with options.out.open("wb") as file:
        head = {"op": b"\x03", "index_pos": bytes(8), "conn_count": bytes(4), "chunk_count": bytes(4)}
        file.write(b"#ROSBAG V2.0\n" + record(head, b" " * 4000))
        for time, topic, kind, data in messages(options, True):
            chunk = b""
            if topic not in connections:
                connections[topic] = len(connections)
                of_type = {"topic": topic.encode(), "type": b"sensor_msgs/" + TYPES[kind].encode(),
                           "md5sum": b"*", "message_definition": b""}
                described = b"".join(length_first(name.encode() + b"=" + value)
                                     for name, value in of_type.items())
                chunk += record({"op": b"\x07", "conn": struct.pack("<I", connections[topic]),
                                 "topic": topic.encode()}, described)
            chunk += record({"op": b"\x02", "conn": struct.pack("<I", connections[topic]),
                             "time": struct.pack("<II", *divmod(time, 10**9))}, data)
            file.write(record({"op": b"\x05", "compression": options.compression.encode(),
                               "size": struct.pack("<I", len(chunk))},
                              compress(options.compression, chunk)))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--images", choices=["raw", "raw-grey", "files"], default="files",
                        help="pixels, luma, or the bytes of the files as compressed images")
    parser.add_argument("--compression", choices=["none", "bz2", "lz4"], default="none",
                        help="of the chunks; bz2 for ROS 1 only")
    parser.add_argument("--settings", type=pathlib.Path, help="for CameraInfo")
    parser.add_argument("--second-topic", metavar="TOPIC",
                        help="gets the images too, as those of a second camera; only with files")
    options = parser.parse_args()
    writers = {".mcap": write_mcap, ".db3": write_sqlite, ".bag": write_ros1}
    if options.out.suffix not in writers:
        parser.error(f"OUT ends in '{options.out.suffix}', expected one of {', '.join(writers)}")
    writers[options.out.suffix](options)


if __name__ == "__main__":
    main()
