// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/codec_lab/cloud_file.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace lidar::tools {
namespace {

constexpr std::size_t kMaxPoints = 50'000'000;

struct PcdField {
  std::string name;
  std::size_t size = 0;
  char type = 0;  // F, U or I
  std::size_t count = 1;
  std::size_t offset = 0;  // bytes
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::string data;
  std::size_t point_size = 0;

  const PcdField* Find(const std::string& name) const {
    for (const PcdField& f : fields)
      if (f.name == name) return &f;
    return nullptr;
  }
};

std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void AddPoint(const float* xyz, const float* intensity, Scan* scan) {
  if (!std::isfinite(xyz[0]) || !std::isfinite(xyz[1]) || !std::isfinite(xyz[2])) return;
  if (xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0) return;
  scan->xyz.insert(scan->xyz.end(), xyz, xyz + 3);
  if (intensity != nullptr) scan->intensity.push_back(*intensity);
}

/// Sets one property of every field, as the header's lines do.
template <class Set>
void ForEachWord(std::istringstream* line, std::vector<PcdField>* fields, const Set& set) {
  std::string word;
  for (std::size_t i = 0; *line >> word; ++i) {
    if (i >= fields->size()) throw std::runtime_error("PCD header: more values than FIELDS");
    set(word, &(*fields)[i]);
  }
}

std::size_t Count(const std::string& word) {
  std::size_t used = 0;
  const unsigned long value = std::stoul(word, &used);
  if (used != word.size() || value > kMaxPoints)
    throw std::runtime_error("PCD header: bad number " + word);
  return value;
}

PcdHeader ReadPcdHeader(std::istream* in) {
  PcdHeader header;
  std::string text;
  while (header.data.empty() && std::getline(*in, text)) {
    std::istringstream line(text);
    std::string key;
    line >> key;
    if (key == "FIELDS") {
      for (std::string name; line >> name;) header.fields.push_back({name, 4, 'F', 1, 0});
    } else if (key == "SIZE") {
      ForEachWord(&line, &header.fields, [](auto& w, PcdField* f) { f->size = Count(w); });
    } else if (key == "TYPE") {
      ForEachWord(&line, &header.fields, [](auto& w, PcdField* f) { f->type = w[0]; });
    } else if (key == "COUNT") {
      ForEachWord(&line, &header.fields, [](auto& w, PcdField* f) { f->count = Count(w); });
    } else if (key == "POINTS") {
      std::string word;
      line >> word;
      header.points = Count(word);
    } else if (key == "DATA") {
      line >> header.data;
    }
  }
  for (PcdField& f : header.fields) {
    f.offset = header.point_size;
    header.point_size += f.size * f.count;
  }
  for (const char* name : {"x", "y", "z"}) {
    const PcdField* f = header.Find(name);
    if (f == nullptr || f->type != 'F' || f->size != 4 || f->count != 1)
      throw std::runtime_error(std::string("PCD: no field ") + name + " of 4-byte floats");
  }
  return header;
}

void ReadAscii(std::istream* in, const PcdHeader& header, Scan* scan) {
  const auto column = [&](const PcdField* f) {
    std::size_t index = 0;
    for (const PcdField* p = header.fields.data(); p != f; ++p) index += p->count;
    return index;
  };
  const PcdField* intensity = header.Find("intensity");
  std::string text;
  for (std::size_t i = 0; i < header.points && std::getline(*in, text); ++i) {
    std::istringstream line(text);
    std::vector<float> values;
    for (std::string word; line >> word;) values.push_back(std::strtof(word.c_str(), nullptr));
    const auto value = [&](const PcdField* f) {
      if (column(f) >= values.size()) throw std::runtime_error("PCD: a line is cut off");
      return values[column(f)];
    };
    const float xyz[3] = {value(header.Find("x")), value(header.Find("y")),
                          value(header.Find("z"))};
    const float level = intensity != nullptr ? value(intensity) : 0;
    AddPoint(xyz, intensity != nullptr ? &level : nullptr, scan);
  }
}

void ReadBinary(std::istream* in, const PcdHeader& header, Scan* scan) {
  const PcdField* intensity = header.Find("intensity");
  if (intensity != nullptr && (intensity->type != 'F' || intensity->size != 4)) intensity = nullptr;
  std::vector<char> point(header.point_size);
  for (std::size_t i = 0; i < header.points; ++i) {
    if (!in->read(point.data(), static_cast<std::streamsize>(point.size())))
      throw std::runtime_error("PCD: the file is cut off");
    const auto value = [&](const PcdField* f) {
      float v = 0;
      std::memcpy(&v, point.data() + f->offset, sizeof v);
      return v;
    };
    const float xyz[3] = {value(header.Find("x")), value(header.Find("y")),
                          value(header.Find("z"))};
    const float level = intensity != nullptr ? value(intensity) : 0;
    AddPoint(xyz, intensity != nullptr ? &level : nullptr, scan);
  }
}

}  // namespace

Scan ReadBin(const std::string& path) {
  const std::string bytes = ReadAll(path);
  constexpr std::size_t kPoint = 4 * sizeof(float);
  if (bytes.empty() || bytes.size() % kPoint != 0)
    throw std::runtime_error(path + ": not a list of x y z intensity floats");
  Scan scan;
  for (std::size_t i = 0; i < bytes.size(); i += kPoint) {
    float point[4];
    std::memcpy(point, bytes.data() + i, sizeof point);
    AddPoint(point, point + 3, &scan);
  }
  return scan;
}

Scan ReadPcd(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path);
  Scan scan;
  try {
    const PcdHeader header = ReadPcdHeader(&file);
    if (header.data == "ascii")
      ReadAscii(&file, header, &scan);
    else if (header.data == "binary")
      ReadBinary(&file, header, &scan);
    else
      throw std::runtime_error("PCD: DATA " + header.data + " is not read, ascii and binary are");
  } catch (const std::exception& e) {
    throw std::runtime_error(path + ": " + e.what());
  }
  return scan;
}

}  // namespace lidar::tools
