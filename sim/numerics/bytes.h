#pragma once

#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "error.h"

namespace continuum {

/// Plain data as bytes, to the last bit, for a process of the same program. One list serves both
/// ways: what is put in as `a(x, y)` comes out as `a(x, y)`. Of a struct the list is a function
/// `template <class A> void Fields(A& a, S& s)` in its namespace. Where that binds the members to
/// names, `auto& [x, y] = s`, it does not compile once another member is there.
class BytesOut {
 public:
  template <class... T>
  void operator()(T&... values) {
    (Put(values), ...);
  }
  std::string& bytes() { return bytes_; }

 private:
  template <class T>
  void Put(T& v) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      bytes_.append(reinterpret_cast<const char*>(&v), sizeof v);
    } else {
      Fields(*this, v);
    }
  }
  void Put(std::string& text) {
    PutSize(text.size());
    bytes_ += text;
  }
  template <class T>
  void Put(std::vector<T>& all) {
    using One = std::conditional_t<std::is_same_v<T, bool>, bool, T&>;
    PutSize(all.size());
    for (One one : all) Put(one);
  }
  template <class T>
  void Put(std::optional<T>& value) {
    bool has = value.has_value();
    Put(has);
    if (has) Put(*value);
  }
  template <int R, int C>
  void Put(Eigen::Matrix<double, R, C>& m) {
    PutSize(static_cast<std::size_t>(m.rows()));
    PutSize(static_cast<std::size_t>(m.cols()));
    bytes_.append(reinterpret_cast<const char*>(m.data()),
                  static_cast<std::size_t>(m.size()) * sizeof(double));
  }
  void PutSize(std::size_t size) { Put(size); }

  std::string bytes_;
};

/// The other way. Throws Error where the bytes are too few.
class BytesIn {
 public:
  explicit BytesIn(const std::string& bytes)
      : at_(bytes.data()), end_(bytes.data() + bytes.size()) {}
  template <class... T>
  void operator()(T&... values) {
    (Take(values), ...);
  }

 private:
  template <class T>
  void Take(T& v) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      Copy(&v, sizeof v);
    } else {
      Fields(*this, v);
    }
  }
  void Take(std::string& text) {
    const std::size_t size = TakeSize();
    Require(size);
    text.resize(size);
    Copy(text.data(), size);
  }
  template <class T>
  void Take(std::vector<T>& all) {
    all.resize(TakeSize());
    for (auto&& one : all) {
      T value{};
      Take(value);
      one = std::move(value);
    }
  }
  template <class T>
  void Take(std::optional<T>& value) {
    bool has = false;
    Take(has);
    value.reset();
    if (has) Take(value.emplace());
  }
  template <int R, int C>
  void Take(Eigen::Matrix<double, R, C>& m) {
    const auto rows = static_cast<Eigen::Index>(TakeSize());
    m.resize(rows, static_cast<Eigen::Index>(TakeSize()));
    Copy(m.data(), static_cast<std::size_t>(m.size()) * sizeof(double));
  }
  std::size_t TakeSize() {
    std::size_t size = 0;
    Take(size);
    return size;
  }
  void Copy(void* to, std::size_t size) {
    Require(size);
    if (size > 0) std::memcpy(to, at_, size);
    at_ += size;
  }
  void Require(std::size_t size) const {
    if (size > static_cast<std::size_t>(end_ - at_)) throw Error::Job("bytes end early");
  }

  const char* at_;
  const char* const end_;
};

/// Of a block of a matrix that has its size on both sides, as J.col(k).
template <class A, class Block>
void FieldsOfBlock(A& a, Block block) {
  Eigen::MatrixXd numbers = block;
  a(numbers);
  block = numbers;
}

template <class T>
std::string ToBytes(T& value) {
  BytesOut out;
  out(value);
  return std::move(out.bytes());
}

template <class T>
T FromBytes(const std::string& bytes) {
  T value;
  BytesIn in(bytes);
  in(value);
  return value;
}

}  // namespace continuum
