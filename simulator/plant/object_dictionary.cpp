// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/object_dictionary.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/check.h"

namespace simulator {
namespace {

using enum ObjectType;
constexpr ObjectAccess kR = ObjectAccess::kRead;
constexpr ObjectAccess kRW = ObjectAccess::kReadWrite;

Object plain(std::uint16_t index, std::uint8_t subindex, ObjectType type, ObjectAccess access,
             std::uint32_t value) {
  Object object;
  object.index = index;
  object.subindex = subindex;
  object.type = type;
  object.access = access;
  object.value = value;
  return object;
}

Object mapped(std::uint16_t index, ObjectType type, ObjectAccess access, std::uint32_t value) {
  Object object = plain(index, 0, type, access, value);
  object.mappable = true;
  return object;
}

Object ranged(Object object, std::int64_t min, std::int64_t max) {
  object.min = min;
  object.max = max;
  return object;
}

void add_communication(std::vector<Object>& list, std::uint32_t node) {
  // Dummies of CiA 301, 7.4.7: fill bytes of a PDO that nobody uses.
  list.push_back(mapped(0x0005, kU8, kRW, 0));
  list.push_back(mapped(0x0006, kU16, kRW, 0));
  list.push_back(mapped(0x0007, kU32, kRW, 0));
  list.push_back(plain(0x1000, 0, kU32, kR, 0x00020192));  // servo drive, CiA 402
  list.push_back(plain(0x1001, 0, kU8, kR, 0));
  list.push_back(ranged(plain(0x1003, 0, kU8, kRW, 0), 0, 0));
  list.push_back(plain(0x1003, 1, kU32, kR, 0));
  list.push_back(plain(0x1005, 0, kU32, kRW, 0x80));
  list.push_back(plain(0x1006, 0, kU32, kRW, 0));
  list.push_back(plain(0x1014, 0, kU32, kR, 0x80 + node));
  list.push_back(plain(0x1016, 0, kU8, kR, 1));
  list.push_back(ranged(plain(0x1016, 1, kU32, kRW, 0), 0, 0x007FFFFF));
  list.push_back(plain(0x1017, 0, kU16, kRW, 0));
  list.push_back(plain(0x1018, 0, kU8, kR, 4));
  for (std::uint8_t sub = 1; sub <= 3; ++sub) list.push_back(plain(0x1018, sub, kU32, kR, 0));
  list.push_back(plain(0x1018, 4, kU32, kR, node));
  list.push_back(plain(0x1029, 0, kU8, kR, 1));
  list.push_back(ranged(plain(0x1029, 1, kU8, kRW, 0), 0, 2));
  list.push_back(plain(0x1200, 0, kU8, kR, 2));
  list.push_back(plain(0x1200, 1, kU32, kR, 0x600 + node));
  list.push_back(plain(0x1200, 2, kU32, kR, 0x580 + node));
}

struct PdoDefaults {
  std::uint16_t communication_index;
  std::uint32_t cob_id;
  std::uint8_t type;
  std::uint16_t event_ms;
  std::vector<std::uint32_t> mapping;  ///< index, subindex, bits as in 1600h
};

void add_pdo(std::vector<Object>& list, const PdoDefaults& pdo) {
  const std::uint16_t communication = pdo.communication_index;
  const auto mapping = static_cast<std::uint16_t>(communication + 0x200);
  list.push_back(plain(communication, 0, kU8, kR, 5));
  list.push_back(plain(communication, 1, kU32, kRW, pdo.cob_id));
  list.push_back(plain(communication, 2, kU8, kRW, pdo.type));
  list.push_back(plain(communication, 3, kU16, kRW, 0));
  list.push_back(plain(communication, 5, kU16, kRW, pdo.event_ms));
  list.push_back(
      ranged(plain(mapping, 0, kU8, kRW, static_cast<std::uint32_t>(pdo.mapping.size())), 0, 8));
  for (std::uint8_t sub = 1; sub <= 8; ++sub) {
    const std::uint32_t entry = sub <= pdo.mapping.size() ? pdo.mapping[sub - 1U] : 0;
    list.push_back(plain(mapping, sub, kU32, kRW, entry));
  }
}

void add_pdos(std::vector<Object>& list, std::uint32_t node, const DriveObjects& has) {
  std::vector<std::uint32_t> command = {0x60400010, 0x607A0020};
  std::vector<std::uint32_t> state = {0x60410010, 0x60640020};
  if (has.max_torque) command.push_back(0x60720010);
  if (has.torque_actual) state.push_back(0x60770010);
  add_pdo(list, {0x1400, 0x200 + node, 1, 0, command});
  add_pdo(list, {0x1401, 0x80000300 + node, 1, 0, {0x60B10020, 0x60B20010, 0x60600008}});
  add_pdo(list, {0x1800, 0x180 + node, 1, 0, state});
  add_pdo(list, {0x1801, 0x280 + node, 255, 100, {0x603F0010, 0x60610008, 0x60FD0020}});
}

void add_drive(std::vector<Object>& list, std::uint32_t rated_mNm) {
  list.push_back(ranged(mapped(0x6007, kI16, kRW, 1), 0, 3));
  list.push_back(mapped(0x603F, kU16, kR, 0));
  list.push_back(mapped(0x6040, kU16, kRW, 0));
  list.push_back(mapped(0x6041, kU16, kR, 0));
  list.push_back(ranged(mapped(0x605A, kI16, kRW, 2), 0, 6));
  list.push_back(ranged(mapped(0x605B, kI16, kRW, 0), 0, 1));
  list.push_back(ranged(mapped(0x605C, kI16, kRW, 1), 0, 1));
  list.push_back(ranged(mapped(0x605E, kI16, kRW, 2), 0, 2));
  list.push_back(ranged(mapped(0x6060, kI8, kRW, 0), 0, 8));
  list.push_back(mapped(0x6061, kI8, kR, 0));
  list.push_back(mapped(0x6064, kI32, kR, 0));
  list.push_back(mapped(0x6065, kU32, kRW, 0xFFFFFFFF));
  list.push_back(mapped(0x6066, kU16, kRW, 0));
  list.push_back(mapped(0x606C, kI32, kR, 0));
  list.push_back(mapped(0x6072, kU16, kRW, 1000));
  list.push_back(plain(0x6076, 0, kU32, kR, rated_mNm));
  list.push_back(mapped(0x6077, kI16, kR, 0));
  list.push_back(mapped(0x607A, kI32, kRW, 0));
  list.push_back(plain(0x607D, 0, kU8, kR, 2));
  list.push_back(plain(0x607D, 1, kI32, kRW, 0x80000000));
  list.push_back(plain(0x607D, 2, kI32, kRW, 0x7FFFFFFF));
  list.push_back(mapped(0x607F, kU32, kRW, 0x7FFFFFFF));
  list.push_back(mapped(0x6080, kU32, kRW, 0x7FFFFFFF));
  list.push_back(mapped(0x6085, kU32, kRW, 200000));
  list.push_back(mapped(0x60B1, kI32, kRW, 0));
  list.push_back(mapped(0x60B2, kI16, kRW, 0));
  list.push_back(plain(0x60C2, 0, kU8, kR, 2));
  list.push_back(plain(0x60C2, 1, kU8, kRW, 1));
  list.push_back(ranged(plain(0x60C2, 2, kI8, kRW, 0xFD), -6, 0));
  list.push_back(mapped(0x60C5, kU32, kRW, 0x7FFFFFFF));
  list.push_back(mapped(0x60FD, kU32, kR, 0));
  list.push_back(plain(0x6502, 0, kU32, kR, 0x80));  // cyclic synchronous position alone
}

bool lies_before(const Object& a, const Object& b) {
  return std::tie(a.index, a.subindex) < std::tie(b.index, b.subindex);
}

}  // namespace

int Object::num_bytes() const {
  if (type == kU8 || type == kI8) return 1;
  return type == kU16 || type == kI16 ? 2 : 4;
}

std::int64_t Object::as_number(std::uint32_t raw) const {
  switch (type) {
    case kI8:
      return static_cast<std::int8_t>(raw);
    case kI16:
      return static_cast<std::int16_t>(raw);
    case kI32:
      return static_cast<std::int32_t>(raw);
    case kU8:
      return raw & 0xFFU;
    case kU16:
      return raw & 0xFFFFU;
    case kU32:
      break;
  }
  return raw;
}

ObjectDictionary::ObjectDictionary(std::uint8_t node_id, const DriveObjects& objects,
                                   double rated_torque_Nm) {
  add_communication(objects_, node_id);
  add_pdos(objects_, node_id, objects);
  add_drive(objects_, static_cast<std::uint32_t>(std::floor(rated_torque_Nm * 1000.0 + 0.5)));
  std::sort(objects_.begin(), objects_.end(), lies_before);
  at(0x6007).hidden = !objects.abort_connection_option;
  at(0x605A).hidden = !objects.quick_stop_option;
  at(0x6072).hidden = !objects.max_torque;
  at(0x6077).hidden = !objects.torque_actual;
  if (at(0x6007).hidden) at(0x6007).value = 0;
  defaults_ = objects_;
}

const Object* ObjectDictionary::find(std::uint16_t index, std::uint8_t subindex) const {
  Object wanted;
  wanted.index = index;
  wanted.subindex = subindex;
  const auto found = std::lower_bound(objects_.begin(), objects_.end(), wanted, lies_before);
  const bool there = found != objects_.end() && found->index == index &&
                     found->subindex == subindex && !found->hidden;
  return there ? &*found : nullptr;
}

Object* ObjectDictionary::find(std::uint16_t index, std::uint8_t subindex) {
  return const_cast<Object*>(std::as_const(*this).find(index, subindex));
}

const Object& ObjectDictionary::at(std::uint16_t index, std::uint8_t subindex) const {
  Object wanted;
  wanted.index = index;
  wanted.subindex = subindex;
  const auto found = std::lower_bound(objects_.begin(), objects_.end(), wanted, lies_before);
  CHECK(found != objects_.end() && found->index == index && found->subindex == subindex,
        "the drive reads only objects of its table");
  return *found;
}

Object& ObjectDictionary::at(std::uint16_t index, std::uint8_t subindex) {
  return const_cast<Object&>(std::as_const(*this).at(index, subindex));
}

AbortCode ObjectDictionary::reason_missing(std::uint16_t index) const {
  const bool known = std::any_of(objects_.begin(), objects_.end(), [index](const Object& object) {
    return object.index == index && !object.hidden;
  });
  return known ? kNoSubindex : kNoObject;
}

AbortCode ObjectDictionary::write(std::uint16_t index, std::uint8_t subindex, std::uint32_t value,
                                  int num_bytes) {
  Object* object = find(index, subindex);
  if (object == nullptr) return reason_missing(index);
  if (object->access == ObjectAccess::kRead) return kReadOnly;
  if (num_bytes > object->num_bytes()) return kTooLong;
  if (num_bytes < object->num_bytes()) return kTooShort;
  const std::int64_t number = object->as_number(value);
  if (number < object->min || number > object->max) return kOutOfRange;
  object->value = value;
  return kNoAbort;
}

void ObjectDictionary::restore(bool communication_only) {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (!communication_only || objects_[i].index < 0x2000) objects_[i].value = defaults_[i].value;
  }
}

}  // namespace simulator
