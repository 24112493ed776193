#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The type hashes in ros_types.h are those of the definitions below, worked out as REP 2016 says."""
import hashlib
import json
import re
import sys

DEFINITIONS = {
    "builtin_interfaces/msg/Time": ["int32 sec", "uint32 nanosec"],
    "std_msgs/msg/Header": ["builtin_interfaces/Time stamp", "string frame_id"],
    "sensor_msgs/msg/PointField": [
        "string name",
        "uint32 offset",
        "uint8 datatype",
        "uint32 count",
    ],
    "sensor_msgs/msg/PointCloud2": [
        "std_msgs/Header header",
        "uint32 height",
        "uint32 width",
        "PointField[] fields",
        "bool is_bigendian",
        "uint32 point_step",
        "uint32 row_step",
        "uint8[] data",
        "bool is_dense",
    ],
    "sensor_msgs/msg/Imu": [
        "std_msgs/Header header",
        "geometry_msgs/Quaternion orientation",
        "float64[9] orientation_covariance",
        "geometry_msgs/Vector3 angular_velocity",
        "float64[9] angular_velocity_covariance",
        "geometry_msgs/Vector3 linear_acceleration",
        "float64[9] linear_acceleration_covariance",
    ],
    "geometry_msgs/msg/Vector3": ["float64 x", "float64 y", "float64 z"],
    "geometry_msgs/msg/Point": ["float64 x", "float64 y", "float64 z"],
    "geometry_msgs/msg/Quaternion": ["float64 x", "float64 y", "float64 z", "float64 w"],
    "geometry_msgs/msg/Pose": ["Point position", "Quaternion orientation"],
    "geometry_msgs/msg/PoseWithCovariance": ["Pose pose", "float64[36] covariance"],
    "geometry_msgs/msg/Twist": ["Vector3 linear", "Vector3 angular"],
    "geometry_msgs/msg/TwistWithCovariance": ["Twist twist", "float64[36] covariance"],
    "geometry_msgs/msg/Transform": ["Vector3 translation", "Quaternion rotation"],
    "geometry_msgs/msg/TransformStamped": [
        "std_msgs/Header header",
        "string child_frame_id",
        "Transform transform",
    ],
    "nav_msgs/msg/Odometry": [
        "std_msgs/Header header",
        "string child_frame_id",
        "geometry_msgs/PoseWithCovariance pose",
        "geometry_msgs/TwistWithCovariance twist",
    ],
    "livox_ros_driver2/msg/CustomPoint": [
        "uint32 offset_time",
        "float32 x",
        "float32 y",
        "float32 z",
        "uint8 reflectivity",
        "uint8 tag",
        "uint8 line",
    ],
    "livox_ros_driver2/msg/CustomMsg": [
        "std_msgs/Header header",
        "uint64 timebase",
        "uint32 point_num",
        "uint8 lidar_id",
        "uint8[3] rsvd",
        "CustomPoint[] points",
    ],
    "point_cloud_interfaces/msg/CompressedPointCloud2": [
        "std_msgs/Header header",
        "uint32 height",
        "uint32 width",
        "sensor_msgs/PointField[] fields",
        "bool is_bigendian",
        "uint32 point_step",
        "uint32 row_step",
        "uint8[] compressed_data",
        "bool is_dense",
        "string format",
    ],
    "tf2_msgs/msg/TFMessage": ["geometry_msgs/TransformStamped[] transforms"],
}
# type_description_interfaces/msg/FieldType
PRIMITIVES = {
    "uint8": 3,
    "int32": 6,
    "uint32": 7,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "string": 17,
}
NESTED, ARRAY, SEQUENCE = 1, 48, 144


def field(message, line):
    kind, name = line.split()
    kind, bracket, length = re.fullmatch(r"([^\[]+)(\[?)(\d*)\]?", kind).groups()
    shape = 0 if not bracket else ARRAY if length else SEQUENCE
    nested = ""
    if kind not in PRIMITIVES:
        package = message.split("/")[0] if "/" not in kind else kind.split("/")[0]
        nested = f"{package}/msg/{kind.split('/')[-1]}"
    return {
        "name": name,
        "type": {
            "type_id": PRIMITIVES.get(kind, NESTED) + shape,
            "capacity": int(length or 0),
            "string_capacity": 0,
            "nested_type_name": nested,
        },
    }


def describe(message):
    lines = DEFINITIONS[message]
    return {"type_name": message, "fields": [field(message, line) for line in lines]}


def parts(message):
    nested = {f["type"]["nested_type_name"] for f in describe(message)["fields"]} - {""}
    return nested.union(*(parts(n) for n in nested))


def type_hash(message):
    description = {
        "type_description": describe(message),
        "referenced_type_descriptions": [describe(n) for n in sorted(parts(message))],
    }
    return "RIHS01_" + hashlib.sha256(json.dumps(description).encode()).hexdigest()


def main():
    text = open(sys.argv[1]).read()
    known = re.findall(r'"(\w+/msg/\w+)",\s*"[\w:]+",\s*"(RIHS01_[0-9a-f]+)"', text)
    wrong = [message for message, hashed in known if type_hash(message) != hashed]
    if len(known) < 6 or wrong:
        sys.exit(f"{len(known)} types found; of another hash: {', '.join(wrong)}")


if __name__ == "__main__":
    main()
