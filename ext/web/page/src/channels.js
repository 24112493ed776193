// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses channels of a server: those of the chosen robot, and slices rather than decoded clouds.
import { canDecode } from './slices.js';

const CLOUDS = ['foxglove.PointCloud', 'foxglove.CompressedPointCloud'];
const SLICES = 'lidar.Slice';
const VIDEO = 'foxglove.CompressedVideo';

/** The topic of a channel's clouds; for slices that of the decoded clouds; null without clouds. */
function cloudTopic({ schemaName, schema, topic }) {
  if (CLOUDS.includes(schemaName)) return topic;
  if (schemaName !== SLICES) return null;
  try {
    return JSON.parse(schema).clouds ?? topic;
  } catch {
    return topic;
  }
}

const robotOf = (topic) => topic.split('/').filter(Boolean)[0];

/** Returns the robots' names if all topics of clouds begin with one: r7 of /r7/points. */
export function robotsOf(list) {
  const topics = list.map(cloudTopic).filter((topic) => topic !== null);
  if (!topics.every((topic) => topic.split('/').filter(Boolean).length > 1)) return [];
  return [...new Set(topics.map(robotOf))].sort();
}

/** `known` has the schemas that the page reads; `idle`: take nothing; `paused`: take no clouds. */
export function chooseChannels(list, { known, robot, idle, paused }) {
  if (idle) return [];
  const robots = robotsOf(list);
  const chosen = robots.includes(robot) ? robot : robots[0];
  const isOthers = ({ topic }) => robotOf(topic) !== chosen && robots.includes(robotOf(topic));
  const decodes = canDecode();
  // The page has one decoder of pictures: frames of two cameras would refer to each other.
  const cameras = list.filter((channel) => channel.schemaName === VIDEO && !isOthers(channel)).map(({ topic }) => topic);
  const [camera] = cameras.sort();
  const coded = new Set(decodes ? list.filter((c) => c.schemaName === SLICES).map(cloudTopic) : []);
  return list.filter((channel) => {
    if (!(channel.schemaName in known) || isOthers(channel)) return false;
    if (channel.schemaName === VIDEO) return channel.topic === camera;
    const topic = cloudTopic(channel);
    if (topic === null) return true;
    if (paused) return false;
    return channel.schemaName === SLICES ? decodes : !coded.has(topic);
  });
}
