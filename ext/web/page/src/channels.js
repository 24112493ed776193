// SPDX-License-Identifier: LGPL-2.1-or-later
// Which channels of a server the page takes: those of the chosen robot, slices before clouds.
import { canDecode } from './slices.js';

const CLOUDS = ['foxglove.PointCloud', 'foxglove.CompressedPointCloud'];
const SLICES = 'lidar.Slice';

/** The topic of the clouds of a channel, or null where it has none. */
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

/** The names of the robots, if the topics of all clouds begin with one: /r7/points. */
export function robotsOf(list) {
  const topics = list.map(cloudTopic).filter((topic) => topic !== null);
  if (!topics.every((topic) => topic.split('/').filter(Boolean).length > 1)) return [];
  return [...new Set(topics.map(robotOf))].sort();
}

/** `known` has the schemas that the page understands; `paused`: it shows no new clouds. */
export function chooseChannels(list, { known, robot, idle, paused }) {
  if (idle) return [];
  const robots = robotsOf(list);
  const chosen = robots.includes(robot) ? robot : robots[0];
  const isOthers = ({ topic }) => robotOf(topic) !== chosen && robots.includes(robotOf(topic));
  const decodes = canDecode();
  const coded = new Set(decodes ? list.filter((c) => c.schemaName === SLICES).map(cloudTopic) : []);
  return list.filter((channel) => {
    if (!(channel.schemaName in known) || isOthers(channel)) return false;
    const topic = cloudTopic(channel);
    if (topic === null) return true;
    if (paused) return false;
    return channel.schemaName === SLICES ? decodes : !coded.has(topic);
  });
}
