// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes the statistics of elements as JSON and in the text format of Prometheus.
#pragma once
#include <gst/gst.h>

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace lidar::fleet {

/// Returns labels in the syntax of Prometheus. The names must not have characters that need an
/// escape.
std::string RobotLabels(const std::string& robot, const std::string& sensor);

/// Converts the numbers, flags, texts and structures in `structure`. Leaves fields of other types
/// out.
nlohmann::json ToJson(const GstStructure* structure);

/// Collects values, and writes them sorted by name, as the text format requires.
class Exposition {
 public:
  /// Adds a value. `labels` includes the braces, or is empty.
  void Add(const std::string& name, const std::string& labels, double value);
  /// Adds each number and flag of `structure` as lidar_`element`_`field`.
  void Add(const std::string& element, const std::string& labels, const GstStructure* structure);
  std::string text() const;

 private:
  std::map<std::string, std::vector<std::string>> lines_;
};

/// Adds the statistics of `elements` in `bin` to `exposition` under `labels`, and to `report` under
/// the names of the elements.
void AddStats(GstElement* bin, const std::vector<std::string>& elements, const std::string& labels,
              Exposition* exposition, nlohmann::json* report);

/// Returns a report as one line. Replaces invalid UTF-8, because error texts from the network may
/// contain any bytes.
std::string ToText(const nlohmann::json& report);

}  // namespace lidar::fleet
