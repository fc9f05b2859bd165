// SPDX-License-Identifier: BSD-3-Clause
// Values that all fade by the same factor with every signal (error, utility), without touching
// them: stored = value * growth, where growth rises by 1 / (1 - decay) per signal.
#pragma once

namespace ddgng {

/// The growth that one group of stored values shares.
class Decay {
 public:
  explicit Decay(float per_signal) : step_(1.0 / (1.0 - static_cast<double>(per_signal))) {}

  float stored(float value) const { return static_cast<float>(value * growth_); }
  float value(float stored) const { return static_cast<float>(stored / growth_); }
  double growth() const { return growth_; }

  void clear() { growth_ = 1.0; }
  void next_signal() { growth_ *= step_; }
  /// Due once in many thousand signals; then multiply every stored value by kShrink and call
  /// shrink(). Powers of two: no value changes (only those faded below 1e-38 vanish).
  bool shrink_due() const { return growth_ >= 1.0 / kShrink; }
  void shrink() { growth_ *= kShrink; }
  static constexpr double kShrink = 0x1p-60;

 private:
  double step_;
  double growth_ = 1.0;
};

}  // namespace ddgng
