// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/report_page.hpp"

#include "base64.hpp"
#include "page_scene.hpp"
#include "page_texts.hpp"

#include <string_view>

#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : valid_utf8(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// An HTML element that contains `text`. `start` is its name with its attributes.
std::string element(std::string_view start, std::string_view text) {
  const std::string name(start.substr(0, start.find(' ')));
  return "<" + std::string(start) + ">" + escaped(text) + "</" + name + ">\n";
}

std::string image(const Picture& picture, const std::string& caption) {
  const std::string png = encoded_png(picture);
  return "<img width=\"" + std::to_string(picture.width_px) + "\" height=\"" +
         std::to_string(picture.height_px) + "\" alt=\"" + escaped(caption) +
         "\" src=\"data:image/png;base64," + base64(png.data(), png.size()) + "\">\n";
}

std::string figure(const PageFigure& figure) {
  return "<figure>" + image(figure.picture, figure.caption) +
         element("figcaption", figure.caption) + "</figure>\n";
}

std::string figures(std::string_view css_class, const std::vector<PageFigure>& all) {
  std::string out = "<div class=\"" + std::string(css_class) + "\">\n";
  for (const PageFigure& one : all) out += figure(one);
  return out + "</div>\n";
}

std::string table_row(const std::vector<std::string>& cells, std::string_view name) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) out += element(name, cell);
  return out + "</tr>\n";
}

/// Radio buttons to choose one of several names. The first is selected.
template <class Named>
std::string choice(const std::string& group, const std::string& label,
                   const std::vector<Named>& all) {
  if (all.size() < 2) {
    return "<input type=\"radio\" name=\"" + group + "\" value=\"0\" checked hidden>\n";
  }
  std::string out = element("span", label);
  for (std::size_t i = 0; i < all.size(); ++i) {
    out += "<label><input type=\"radio\" name=\"" + group + "\" value=\"" + std::to_string(i) +
           "\"" + (i == 0 ? " checked" : "") + "> " + escaped(all[i].name) + "</label>\n";
  }
  return out;
}

std::string script(std::string_view text) { return "<script>" + std::string(text) + "</script>\n"; }

}  // namespace

ReportPage::ReportPage(std::string title, const std::string& subtitle) : title_(std::move(title)) {
  body_ = element("h1", title_) + element("p class=\"subtitle\"", subtitle);
}

void ReportPage::add_verdict(Verdict verdict, const std::string& sentence) {
  body_ += "<div class=\"verdict " + std::string(name_of(verdict)) + "\">" +
           element("b", sentence_of(verdict)) + escaped(sentence) + "</div>\n";
}

void ReportPage::add_warnings(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  body_ += "<ul class=\"warnings\">\n";
  for (const std::string& warning : warnings) body_ += element("li", warning);
  body_ += "</ul>\n";
}

void ReportPage::add_heading(const std::string& heading) { body_ += element("h2", heading); }

void ReportPage::add_text(const std::string& paragraph) { body_ += element("p", paragraph); }

void ReportPage::add_figures(const std::vector<PageFigure>& all) {
  body_ += figures(all.size() > 1 ? "figures halves" : "figures", all);
}

void ReportPage::add_table(const PageTable& table) {
  body_ += "<div class=\"scroll\"><table>\n<thead>" + table_row(table.header, "th") +
           "</thead>\n<tbody>";
  for (const auto& row : table.rows) body_ += table_row(row, "td");
  body_ += "</tbody></table></div>\n";
}

void ReportPage::add_folded(const std::string& summary, const std::string& text) {
  body_ += "<details>" + element("summary", summary) + element("pre", text) + "</details>\n";
}

void ReportPage::add_strip(const std::vector<StripFrame>& frames,
                           const std::vector<PageFigure>& legends) {
  if (frames.empty()) return;
  has_strip_ = true;
  body_ +=
      "<div class=\"strip\" tabindex=\"0\" aria-label=\"frames\">\n"
      "<div class=\"controls\" hidden><button type=\"button\" class=\"previous\">Previous"
      "</button><input type=\"range\" min=\"0\" value=\"0\" aria-label=\"frame\" max=\"" +
      std::to_string(frames.size() - 1) +
      "\"><button type=\"button\" class=\"next\">Next</button><output></output></div>\n";
  for (const StripFrame& frame : frames) {
    body_ +=
        "<section class=\"frame\">" + element("h3", frame.title) + figures("panels", frame.panels);
    if (!frame.remark.empty()) body_ += element("p", frame.remark);
    body_ += "</section>\n";
  }
  body_ += figures("figures", legends) + "</div>\n";
}

void ReportPage::add_scene(const PageScene& scene) {
  const std::string json = scene_json(scene);
  const std::string number = std::to_string(scenes_++);  // makes group names unique
  body_ +=
      "<div class=\"scene\">\n<div class=\"controls\" hidden>\n" +
      choice("cloud" + number, "Map:", scene.clouds) + "</div>\n" +
      "<div class=\"controls\" hidden>\n" +
      choice("coloring" + number, "Colour:", scene.colorings) +
      "<button type=\"button\" data-view=\"corner\">From a corner</button>\n"
      "<button type=\"button\" data-view=\"above\">From above</button>\n"
      "<button type=\"button\" data-view=\"side\">From the side</button>\n</div>\n"
      "<div class=\"canvas\">The 3D view needs scripts and WebGL.</div>\n<div class=\"figures\">";
  for (const SceneColoring& coloring : scene.colorings) {
    body_ += "<figure class=\"legend\">" + image(coloring.legend, "colours of " + coloring.name) +
             "</figure>\n";
  }
  body_ += "</div>\n<script type=\"application/json\">";
  for (const char c : json) body_ += c == '<' ? std::string("\\u003c") : std::string(1, c);
  body_ += "</script>\n</div>\n";
}

std::string ReportPage::html() const {
  std::string out =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
      element("title", title_) + "<link rel=\"icon\" href=\"data:,\">\n<style>" +
      std::string(page_texts::style) + "</style>\n</head>\n<body>\n<main>\n" + body_ + "</main>\n";
  if (has_strip_) out += script(page_texts::strip);
  if (scenes_ > 0) {
    out += "<!--\n" + std::string(page_texts::three_notice) + "-->\n" + script(page_texts::three) +
           script(page_texts::orbit_controls) + script(page_texts::scene);
  }
  return out + "</body>\n</html>\n";
}

}  // namespace tofmap
