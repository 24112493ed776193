// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses channels of the server: those of the chosen robot, and slices instead of decoded clouds.
import { canDecode } from './slices.js';

const CLOUDS = ['foxglove.PointCloud', 'foxglove.CompressedPointCloud'];
const SLICES = 'lidar.Slice';
const VIDEO = 'foxglove.CompressedVideo';

/**
 * Returns the topic of the channel's clouds. For a channel of slices, returns the topic of the
 * decoded clouds. Returns null if the channel has no clouds.
 */
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

/**
 * Returns the names of the robots. Returns none unless each topic of clouds begins with a name, as
 * r7 in /r7/points.
 */
export function robotsOf(list) {
  const topics = list.map(cloudTopic).filter((topic) => topic !== null);
  if (!topics.every((topic) => topic.split('/').filter(Boolean).length > 1)) return [];
  return [...new Set(topics.map(robotOf))].sort();
}

/**
 * Returns the channels to subscribe to. `known` has the schemas that the page reads. If `idle`,
 * returns no channels. If `paused`, returns no channels of clouds.
 */
export function chooseChannels(list, { known, robot, idle, paused }) {
  if (idle) return [];
  const robots = robotsOf(list);
  const chosen = robots.includes(robot) ? robot : robots[0];
  const isOthers = ({ topic }) => robotOf(topic) !== chosen && robots.includes(robotOf(topic));
  const decodes = canDecode();
  // Only one camera is chosen, because the page has only one video decoder, whose frames refer to
  // earlier frames.
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
