// SPDX-License-Identifier: LGPL-2.1-or-later
// A ROS 2 node on Cyclone DDS, whose types are those of Cyclone's own compiler.
//
//     peer sub TOPIC FRAME   takes three clouds; fails if one is wrong
//     peer pub TOPIC FRAME   publishes clouds until it is killed
//     peer data              prints the points of those clouds
#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ros.h"

typedef sensor_msgs_msg_dds__PointCloud2_ Cloud;
typedef sensor_msgs_msg_dds__PointField_ Field;

enum { kWidth = 1024, kHeight = 16, kStep = 20, kSize = kWidth * kHeight * kStep, kClouds = 3 };

static unsigned char points[kSize];

static int fail(const char* what) {
  fprintf(stderr, "peer: %s\n", what);
  return 1;
}

static dds_qos_t* reliable(void) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 5);
  return qos;
}

/// Returns what is wrong with a cloud of lidartestsrc, whose fields are x, y, z, intensity and
/// range in this order; NULL if it is right.
static const char* wrong_with(const Cloud* cloud, const char* frame) {
  static const char* const names[] = {"x", "y", "z", "intensity", "range"};
  static const unsigned char types[] = {7, 7, 7, 7, 6};
  if (strcmp(cloud->header.frame_id, frame) != 0) return "another frame";
  if (cloud->header.stamp.sec < 1600000000) return "no time";
  if (cloud->fields._length != 5 || cloud->point_step != 20) return "other fields";
  for (uint32_t i = 0; i < 5; ++i) {
    const Field* field = &cloud->fields._buffer[i];
    if (strcmp(field->name, names[i]) != 0 || field->datatype != types[i] ||
        field->offset != 4 * i || field->count != 1)
      return "another field";
  }
  if (cloud->height != 32 || cloud->width != 512) return "another size";
  if (cloud->is_bigendian || cloud->row_step != 512 * 20) return "another layout";
  if (cloud->data._length != 32 * 512 * 20) return "data of another size";
  return NULL;
}

static int subscribe(dds_entity_t participant, dds_entity_t topic, const char* frame) {
  const dds_entity_t reader = dds_create_reader(participant, topic, reliable(), NULL);
  int taken = 0;
  for (int i = 0; i < 3000 && taken < kClouds; ++i) {
    void* sample = NULL;
    dds_sample_info_t info;
    if (dds_take(reader, &sample, &info, 1, 1) < 1) {
      dds_sleepfor(DDS_MSECS(20));
      continue;
    }
    const char* wrong = info.valid_data ? wrong_with(sample, frame) : NULL;
    if (wrong != NULL) return fail(wrong);
    taken += info.valid_data ? 1 : 0;
    dds_return_loan(reader, &sample, 1);
  }
  return taken < kClouds ? fail("no clouds") : 0;
}

static int publish(dds_entity_t participant, dds_entity_t topic, char* frame) {
  static char* const names[] = {"x", "y", "z", "intensity", "range"};
  static const unsigned char types[] = {7, 7, 7, 7, 6};
  const dds_entity_t writer = dds_create_writer(participant, topic, reliable(), NULL);
  Field fields[5];
  for (uint32_t i = 0; i < 5; ++i) fields[i] = (Field){names[i], 4 * i, types[i], 1};
  Cloud cloud;
  memset(&cloud, 0, sizeof cloud);
  cloud.header.frame_id = frame;
  cloud.height = kHeight;
  cloud.width = kWidth;
  cloud.point_step = kStep;
  cloud.row_step = kStep * kWidth;
  cloud.fields._length = cloud.fields._maximum = 5;
  cloud.fields._buffer = fields;
  cloud.data._length = cloud.data._maximum = kSize;
  cloud.data._buffer = points;
  for (;; dds_sleepfor(DDS_MSECS(100))) {
    const dds_time_t now = dds_time();
    cloud.header.stamp.sec = (int32_t)(now / DDS_NSECS_IN_SEC);
    cloud.header.stamp.nanosec = (uint32_t)(now % DDS_NSECS_IN_SEC);
    if (dds_write(writer, &cloud) < 0) return fail("a cloud cannot be written");
  }
}

int main(int argc, char** argv) {
  for (size_t i = 0; i < kSize; ++i) points[i] = (unsigned char)(i * 7 + i / 251);
  if (argc == 2 && strcmp(argv[1], "data") == 0) return fwrite(points, kSize, 1, stdout) != 1;
  if (argc != 4) return fail("sub|pub TOPIC FRAME, or data");
  const char* domain = getenv("ROS_DOMAIN_ID");
  const dds_entity_t participant =
      dds_create_participant(domain != NULL ? (uint32_t)atoi(domain) : 0, NULL, NULL);
  if (participant < 0) return fail("no participant");
  const dds_entity_t topic =
      dds_create_topic(participant, &sensor_msgs_msg_dds__PointCloud2__desc, argv[2], NULL, NULL);
  if (topic < 0) return fail("no topic");
  return strcmp(argv[1], "sub") == 0 ? subscribe(participant, topic, argv[3])
                                     : publish(participant, topic, argv[3]);
}
