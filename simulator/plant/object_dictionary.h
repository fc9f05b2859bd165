// SPDX-License-Identifier: BSD-3-Clause
// The objects of one drive (CiA 301 and 402): value, type, access and range, and what a master is
// answered when it asks for something that is not there. Objects that a small drive lacks are
// hidden: the drive goes on with their defaults, the master gets an abort.
#pragma once

#include <cstdint>
#include <vector>

namespace simulator {

/// Abort codes of CiA 301, table 22.
enum AbortCode : std::uint32_t {
  kNoAbort = 0,
  kUnknownCommand = 0x05040001,
  kUnsupportedAccess = 0x06010000,
  kWriteOnly = 0x06010001,
  kReadOnly = 0x06010002,
  kNoObject = 0x06020000,
  kNotMappable = 0x06040041,
  kPdoTooLong = 0x06040042,
  kWrongSize = 0x06070010,
  kTooLong = 0x06070012,
  kTooShort = 0x06070013,
  kNoSubindex = 0x06090011,
  kOutOfRange = 0x06090030,
  kWrongState = 0x08000022,
};

enum class ObjectType : std::uint8_t { kU8, kI8, kU16, kI16, kU32, kI32 };
enum class ObjectAccess : std::uint8_t { kRead, kReadWrite };

struct Object {
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  ObjectType type = ObjectType::kU32;
  ObjectAccess access = ObjectAccess::kRead;
  bool mappable = false;
  std::uint32_t value = 0;
  std::int64_t min = INT64_MIN;  ///< of a write
  std::int64_t max = INT64_MAX;
  bool hidden = false;

  int num_bytes() const;
  std::int64_t number() const { return as_number(value); }
  std::int64_t as_number(std::uint32_t raw) const;
};

/// What of the standard this drive has.
struct DriveObjects {
  bool abort_connection_option = true;  ///< 6007h
  bool quick_stop_option = true;        ///< 605Ah
  bool max_torque = true;               ///< 6072h
  bool torque_actual = true;            ///< 6077h
};

class ObjectDictionary {
 public:
  ObjectDictionary(std::uint8_t node_id, const DriveObjects& objects, double rated_torque_Nm);

  /// Null when the master may not know of it.
  const Object* find(std::uint16_t index, std::uint8_t subindex) const;
  Object* find(std::uint16_t index, std::uint8_t subindex);

  /// The drive's own access, hidden or not; the object must be in the table.
  Object& at(std::uint16_t index, std::uint8_t subindex = 0);
  const Object& at(std::uint16_t index, std::uint8_t subindex = 0) const;
  std::int64_t number(std::uint16_t index, std::uint8_t subindex = 0) const {
    return at(index, subindex).number();
  }

  /// kNoObject or kNoSubindex for what find() does not find.
  AbortCode reason_missing(std::uint16_t index) const;
  /// A master's write; the rules of PDO objects are in pdo.h.
  AbortCode write(std::uint16_t index, std::uint8_t subindex, std::uint32_t value, int num_bytes);

  /// As after power-on; only the communication profile (1000h..1FFFh) when asked.
  void restore(bool communication_only);

 private:
  std::vector<Object> objects_;  ///< sorted by (index, subindex), never resized after construction
  std::vector<Object> defaults_;
};

}  // namespace simulator
