#include "sim/mat.h"

#include <memory>

#include <matio.h>

#include "error.h"
#include "sim/file.h"

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

std::vector<double> Numbers(const matvar_t& v, const std::string& where) {
  std::size_t n = 1;
  for (int i = 0; i < v.rank; ++i) n *= v.dims[i];
  std::vector<double> out(n);
  const auto convert = [&](auto* data) { out.assign(data, data + n); };
  if (!v.data) throw Error::Input(where, "real numbers", "no data");
  if (v.isComplex) throw Error::Input(where, "real numbers", "complex numbers");
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
    case MAT_C_UINT8:
      convert(static_cast<const unsigned char*>(v.data));
      break;
    default:
      throw Error::Input(where, "a numeric matrix", ClassName(v.class_type));
  }
  return out;
}

}  // namespace

Columns ReadMat(const std::filesystem::path& file, const std::string& variable) {
  RequireFile(file);
  const std::unique_ptr<mat_t, Close> mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  if (!mat) throw Error::Input(file.string(), "a MATLAB file", "none");
  Columns columns;
  if (!variable.empty()) {
    const std::unique_ptr<matvar_t, Close> v(Mat_VarRead(mat.get(), variable.c_str()));
    const std::string where = file.string() + ": " + variable;
    if (!v) throw Error::Input(where, "a variable of this name", "none");
    if (v->rank != 2)
      throw Error::Input(where, "a matrix", std::to_string(v->rank) + " dimensions");
    const auto all = Numbers(*v, where);
    const std::size_t rows = v->dims[0];
    for (std::size_t c = 0; c < v->dims[1]; ++c) {
      columns.names.push_back(std::to_string(c + 1));
      columns.values.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(c * rows),
                                  all.begin() + static_cast<std::ptrdiff_t>((c + 1) * rows));
    }
    return columns;
  }
  while (const std::unique_ptr<matvar_t, Close> v{Mat_VarReadNext(mat.get())}) {
    if (v->rank != 2 || (v->dims[0] != 1 && v->dims[1] != 1)) continue;
    if (v->class_type == MAT_C_CHAR || v->class_type == MAT_C_CELL) continue;
    auto values = Numbers(*v, file.string() + ": " + v->name);
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
