#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace continuum {

/// A text without blanks, tabs and carriage returns at its ends.
std::string_view TrimBlanks(std::string_view text);

/// Whether a line of a text table is a comment: it begins with '#', '%' or "//", or is the line by
/// which Excel knows the delimiter, "sep=;".
bool IsComment(std::string_view line);

/// Whether a cell says that a value was not measured: empty, "nan", "NA", "null", "-" and the like,
/// as pandas, Excel and C runtimes write it.
bool IsMissing(std::string_view cell);

/// Whether a cell is a number, written with a decimal point or a decimal comma.
bool IsNumber(std::string_view cell);
/// Whether it is one with a decimal comma: "0,5".
bool HasDecimalComma(std::string_view cell);

/// The cells of one line. delimiter: the character between them; ' ' is any run of blanks. A quoted
/// cell may hold delimiters and doubled quotes, but no line break. Throws Error (where) for an open
/// quote and for text after a quoted cell.
std::vector<std::string> SplitCells(std::string_view line, char delimiter,
                                    const std::string& where);

/// What stands between the cells of a table: ',' ';' '|' a tab, or ' ' for any run of blanks. It is
/// the one that gives most lines as many cells as the first, and most numbers.
char DelimiterOf(const std::vector<std::string_view>& lines);

}  // namespace continuum
