#include "sim/io/mat_file.h"

#include <cstdint>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <matio.h>

#include "error.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

struct Close {
  void operator()(mat_t* f) const { Mat_Close(f); }
  void operator()(matvar_t* v) const { Mat_VarFree(v); }
};

const char* ClassName(matio_classes type) {
  switch (type) {
    case MAT_C_CELL:
      return "a cell array";
    case MAT_C_STRUCT:
      return "a structure";
    case MAT_C_OBJECT:
    case MAT_C_OPAQUE:
      return "an object";
    case MAT_C_CHAR:
      return "text";
    case MAT_C_SPARSE:
      return "a sparse matrix";
    case MAT_C_FUNCTION:
      return "a function";
    default:
      return "integers of another width";
  }
}

// A file may promise more numbers than it can hold, and matio makes room for them. Deflate, the
// densest that it knows, makes at most 1032 bytes of one.
std::size_t Count(const matvar_t& v, const std::string& where, std::uintmax_t file_size) {
  const std::uintmax_t most = 1032 * file_size;
  std::uintmax_t n = 1;
  for (int i = 0; i < v.rank; ++i) {
    if (v.dims[i] > 0 && n > most / v.dims[i])
      throw Error::Input(where, "at most " + std::to_string(most) + " numbers in such a file",
                         "more");
    n *= v.dims[i];
  }
  return n;
}

void RequireNumeric(const matvar_t& v, const std::string& where) {
  if (v.isComplex) throw Error::Input(where, "real numbers", "complex numbers");
  switch (v.class_type) {
    case MAT_C_DOUBLE:
    case MAT_C_SINGLE:
    case MAT_C_INT32:
    case MAT_C_INT16:
    case MAT_C_UINT8:
      return;
    default:
      throw Error::Input(where, "a numeric matrix", ClassName(v.class_type));
  }
}

// Reads the data of a variable of which matio knows the size.
std::vector<double> Numbers(mat_t& mat, matvar_t& v, const std::string& where,
                            std::uintmax_t file_size) {
  RequireNumeric(v, where);
  const std::size_t n = Count(v, where, file_size);
  const bool read = Mat_VarReadDataAll(&mat, &v) == 0;
  if (n == 0) return {};
  if (!read || !v.data || v.data_size <= 0 || v.nbytes / v.data_size < n)
    throw Error::Input(where, std::to_string(n) + " real numbers", "no data or damaged data");
  std::vector<double> out;
  const auto convert = [&](auto* data) { out.assign(data, data + n); };
  switch (v.class_type) {
    case MAT_C_DOUBLE:
      convert(static_cast<const double*>(v.data));
      break;
    case MAT_C_SINGLE:
      convert(static_cast<const float*>(v.data));
      break;
    case MAT_C_INT32:
      convert(static_cast<const int*>(v.data));
      break;
    case MAT_C_INT16:
      convert(static_cast<const short*>(v.data));
      break;
    default:
      convert(static_cast<const unsigned char*>(v.data));
  }
  return out;
}

}  // namespace

Columns ReadMat(const std::filesystem::path& file, const std::string& variable) {
  RequireFile(file);
  const std::unique_ptr<mat_t, Close> mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  // What has no header matio takes for version 4.
  if (!mat || Mat_GetVersion(mat.get()) == MAT_FT_MAT4)
    throw Error::Input(file.string(), "a MATLAB file of version 5 or 7.3", "none");
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  Columns columns;
  if (!variable.empty()) {
    const std::unique_ptr<matvar_t, Close> v(Mat_VarReadInfo(mat.get(), variable.c_str()));
    const std::string where = file.string() + ": " + variable;
    if (!v) throw Error::Input(where, "a variable of this name", "none");
    if (v->rank != 2)
      throw Error::Input(where, "a matrix", std::to_string(v->rank) + " dimensions");
    const auto all = Numbers(*mat, *v, where, size);
    if (all.empty()) throw Error::Input(where, "a matrix of numbers", "an empty one");
    const std::size_t rows = v->dims[0];
    for (std::size_t c = 0; c < v->dims[1]; ++c) {
      columns.names.push_back(std::to_string(c + 1));
      columns.values.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(c * rows),
                                  all.begin() + static_cast<std::ptrdiff_t>((c + 1) * rows));
    }
    return columns;
  }
  while (const std::unique_ptr<matvar_t, Close> v{Mat_VarReadNextInfo(mat.get())}) {
    if (v->rank != 2 || (v->dims[0] != 1 && v->dims[1] != 1)) continue;
    if (v->class_type == MAT_C_CHAR || v->class_type == MAT_C_CELL) continue;
    if (!v->name) throw Error::Input(file.string(), "variables with names", "one without");
    auto values = Numbers(*mat, *v, file.string() + ": " + v->name, size);
    if (values.size() < 2) continue;
    if (!columns.values.empty() && values.size() != columns.values.front().size()) {
      throw Error::Input(file.string() + ": " + v->name,
                         std::to_string(columns.values.front().size()) + " values as in '" +
                             columns.names.front() + "'",
                         std::to_string(values.size()));
    }
    columns.names.emplace_back(v->name);
    columns.values.push_back(std::move(values));
  }
  if (columns.names.empty()) throw Error::Input(file.string(), "numeric vectors", "none");
  return columns;
}

}  // namespace continuum
