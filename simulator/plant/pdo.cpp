// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/pdo.h"

namespace simulator {
namespace {

constexpr std::uint32_t kInvalidBit = 0x80000000U;
constexpr std::uint16_t kMappingOffset = 0x200;

struct MappingEntry {
  std::uint16_t index;
  std::uint8_t subindex;
  int num_bits;
};

MappingEntry entry_of(std::uint32_t value) {
  return {static_cast<std::uint16_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
          static_cast<int>(value & 0xFF)};
}

bool is_mapping(std::uint16_t index) {
  return (index & kMappingOffset) != 0;
}

AbortCode check_entry(const ObjectDictionary& dictionary, std::uint32_t value) {
  const MappingEntry entry = entry_of(value);
  const Object* object = dictionary.find(entry.index, entry.subindex);
  if (object == nullptr) return dictionary.reason_missing(entry.index);
  if (!object->mappable || entry.num_bits != 8 * object->num_bytes()) return kNotMappable;
  return kNoAbort;
}

AbortCode check_count(const ObjectDictionary& dictionary, std::uint16_t index,
                      std::uint32_t count) {
  if (count > 8) return kOutOfRange;
  int num_bits = 0;
  for (std::uint32_t i = 1; i <= count; ++i) {
    const std::uint32_t value = dictionary.at(index, static_cast<std::uint8_t>(i)).value;
    if (const AbortCode abort = check_entry(dictionary, value); abort != kNoAbort) return abort;
    num_bits += entry_of(value).num_bits;
  }
  return num_bits > 64 ? kPdoTooLong : kNoAbort;
}

}  // namespace

void Pdo::configure(ObjectDictionary& dictionary) {
  const std::uint32_t cob_id = dictionary.at(communication_index_, 1).value;
  const auto mapping_index = static_cast<std::uint16_t>(communication_index_ + kMappingOffset);
  id_ = cob_id & 0x7FF;
  type_ = static_cast<std::uint8_t>(dictionary.at(communication_index_, 2).value);
  event_us_ = dictionary.number(communication_index_, 5) * 1000;
  num_objects_ = static_cast<int>(dictionary.at(mapping_index, 0).value);
  valid_ = (cob_id & kInvalidBit) == 0 && num_objects_ > 0;
  length_ = 0;
  for (int i = 0; i < num_objects_; ++i) {
    const MappingEntry entry =
        entry_of(dictionary.at(mapping_index, static_cast<std::uint8_t>(i + 1)).value);
    objects_[static_cast<std::size_t>(i)] = &dictionary.at(entry.index, entry.subindex);
    length_ += objects_[static_cast<std::size_t>(i)]->num_bytes();
  }
}

BusFrame Pdo::packed() const {
  BusFrame frame;
  frame.id = id_;
  int offset = 0;
  for (int i = 0; i < num_objects_; ++i) {
    const Object& object = *objects_[static_cast<std::size_t>(i)];
    put_number(frame, offset, object.num_bytes(), object.value);
    offset += object.num_bytes();
  }
  frame.length = static_cast<std::uint8_t>(offset);
  return frame;
}

void Pdo::unpack(const BusFrame& frame) const {
  int offset = 0;
  for (int i = 0; i < num_objects_; ++i) {
    Object& object = *objects_[static_cast<std::size_t>(i)];
    object.value = number_at(frame, offset, object.num_bytes());
    offset += object.num_bytes();
  }
}

bool belongs_to_pdo(std::uint16_t index) {
  return index >= 0x1400 && index < 0x1C00;
}

AbortCode check_pdo_write(const ObjectDictionary& dictionary, std::uint16_t index,
                          std::uint8_t subindex, std::uint32_t value) {
  if (!belongs_to_pdo(index) || dictionary.find(index, subindex) == nullptr) return kNoAbort;
  if (!is_mapping(index)) {
    const std::uint32_t now = dictionary.at(index, 1).value;
    const bool renames =
        subindex == 1 && (now & kInvalidBit) == 0 && (value & kInvalidBit) == 0 && now != value;
    return renames ? kWrongState : kNoAbort;
  }
  const auto communication = static_cast<std::uint16_t>(index - kMappingOffset);
  if ((dictionary.at(communication, 1).value & kInvalidBit) == 0) return kWrongState;
  if (subindex == 0) return check_count(dictionary, index, value);
  if (dictionary.at(index, 0).value != 0) return kUnsupportedAccess;
  return check_entry(dictionary, value);
}

}  // namespace simulator
