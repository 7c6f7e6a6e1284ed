// SPDX-License-Identifier: Apache-2.0
#include "gateway/manual/manual_page.hpp"

#include <cctype>
#include <sstream>

#include "gateway/manual/roff.hpp"

namespace axisgate::manual {
namespace {

std::string capitals(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// A footer has lines that were broken for a terminal, and others that begin something: these open with a capital.
std::string paragraph(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(' ');
    if (first == std::string::npos) continue;
    if (!out.empty() && std::isupper(static_cast<unsigned char>(line.front())) != 0) out += ".br\n";
    out += plain(line.substr(first)) + "\n";
  }
  return out;
}

std::string heading(const Option& option) {
  std::string out;
  for (const std::string& name : option.names) out += (out.empty() ? "" : ", ") + bold(name);
  return option.value.empty() ? out : out + " " + slanted(option.value);
}

std::string entries(const Command& command) {
  std::string out;
  for (const Option& argument : command.arguments)
    out += ".TP\n" + slanted(argument.value) + "\n" + paragraph(argument.what);
  for (const Option& option : command.options) {
    out += ".TP\n" + heading(option) + "\n" + paragraph(option.what);
    if (!option.initial.empty()) out += "(" + plain(option.initial) + " if it is not given)\n";
  }
  return out;
}

std::string usage(const std::string& name, const Command& command) {
  std::string out = bold(name);
  if (!command.options.empty()) out += " [" + slanted("OPTIONS") + "]";
  for (const Option& argument : command.arguments) {
    const std::string shown = slanted(argument.value) + (argument.repeated ? "..." : "");
    out += " " + (argument.required ? shown : "[" + shown + "]");
  }
  return out + "\n";
}

void synopsis(const std::string& name, const Command& command, std::string& out) {
  if (command.commands.empty()) out += (out.empty() ? "" : ".br\n") + usage(name, command);
  for (const Command& one : command.commands) synopsis(name + " " + one.name, one, out);
}

void sections(const std::string& name, const Command& command, std::string& out) {
  for (const Command& one : command.commands) {
    const std::string full = name + " " + one.name;
    out += ".SS \"" + plain(full) + "\"\n" + paragraph(one.what) + entries(one);
    // A group of commands has CLI11's copy of the footer above it.
    if (!one.footer.empty() && one.footer != command.footer) out += ".PP\n" + paragraph(one.footer);
    sections(full, one, out);
  }
}

/// "axisgate: motor drives ..." says its name, which stands before it already.
std::string without_name(const Command& program) {
  const std::string name = program.name + ": ";
  return program.what.starts_with(name) ? program.what.substr(name.size()) : program.what;
}

}  // namespace

std::string manual_page(const Command& program, const std::string& version) {
  std::string out = ".\\\" Made from the command line of " + program.name + ".\n";
  out += ".TH \"" + capitals(plain(program.name)) + "\" 1 \"\" \"axisgate " + version + "\" \"axisgate\"\n.nh\n.ad l\n";
  out += ".SH NAME\n" + plain(program.name) + " \\- " + paragraph(without_name(program));
  std::string forms;
  synopsis(program.name, program, forms);
  out += ".SH SYNOPSIS\n" + forms;
  out += ".SH OPTIONS\n" + entries(program);
  if (!program.footer.empty()) out += ".PP\n" + paragraph(program.footer);
  if (!program.commands.empty()) {
    out += ".SH COMMANDS\n";
    sections(program.name, program, out);
  }
  out += ".SH SEE ALSO\n";
  std::string others;
  for (const char* const page : {"axisgate(1)", "axisgate-dds(1)", "axisgate-sim(1)", "gateway.json(5)"}) {
    const std::string name = std::string(page).substr(0, std::string(page).find('('));
    if (name == program.name) continue;
    others += (others.empty() ? "" : ",\n") + bold(name) + std::string(page).substr(name.size());
  }
  return out + others + "\n";
}

}  // namespace axisgate::manual
