// How many fields a plain struct has, so that a field without a key is noticed.
#pragma once

#include <cstddef>

namespace rilo {

/// Stands for a value of any type in a list of initial values; never converted at run time.
struct AnyValue {
  template <typename T>
  operator T() const;  // NOLINT(google-explicit-constructor)
};

template <typename Struct, std::size_t... kPlaces>
constexpr bool takes_values(std::index_sequence<kPlaces...>) {
  return requires { Struct{((void)kPlaces, AnyValue{})...}; };
}

/// The largest number of initial values that `Struct` takes.
template <typename Struct, std::size_t kCount = 0>
constexpr std::size_t field_count() {
  if constexpr (takes_values<Struct>(std::make_index_sequence<kCount + 1>{})) {
    return field_count<Struct, kCount + 1>();
  } else {
    return kCount;
  }
}

}  // namespace rilo
