// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap {
namespace {

using testing::HasSubstr;
using testing::Not;

ReportPage empty_page() { return {"A <title>", "made by hand"}; }

/// Two points in a cloud of one colouring, and a path between them.
PageScene small_scene() {
  PageScene scene;
  scene.colorings = {{"height", Picture(20, 40)}};
  scene.clouds = {{"a </script> cloud",
                   {{0, 0, 0}, {1, 2, 4}},
                   {{0, 0, 1}, {0, 0, 0}},
                   {{{1, 2, 3}, {4, 5, 6}}}}};
  scene.paths = {{"path", {{0, 0, 0}, {1, 2, 4}}, {255, 0, 16}}};
  return scene;
}

nlohmann::json scene_json(const std::string& html) {
  const std::string start = "<script type=\"application/json\">";
  const std::size_t begin = html.find(start) + start.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST(ReportPage, ShowsTextsAsTheyAre) {
  ReportPage page = empty_page();
  page.add_text("a < b & \"c\"");
  page.add_folded("options", "x: <1>\n  y: 2\n");
  const std::string html = page.html();
  EXPECT_THAT(html, HasSubstr("<title>A &lt;title&gt;</title>"));
  EXPECT_THAT(html, HasSubstr("<p>a &lt; b &amp; &quot;c&quot;</p>"));
  EXPECT_THAT(html, HasSubstr("<pre>x: &lt;1&gt;\n  y: 2\n</pre>"));
}

TEST(ReportPage, TellsVerdictsInWordsToo) {
  ReportPage page = empty_page();
  page.add_verdict(Verdict::check, "half of it");
  EXPECT_THAT(page.html(), HasSubstr("class=\"verdict check\""));
  EXPECT_THAT(page.html(), HasSubstr("Check this result."));
}

TEST(ReportPage, LeavesOutWhatIsEmpty) {
  ReportPage page = empty_page();
  page.add_warnings({});
  page.add_strip({}, {});
  const std::string html = page.html();
  EXPECT_THAT(html, Not(HasSubstr("<ul")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST(ReportPage, HoldsAllThatItNeeds) {
  ReportPage page = empty_page();
  page.add_figures({{Picture(3, 2, {255, 0, 0}), "red \"box\""}});
  page.add_strip({{"Frame 0", {{Picture(2, 2), "range"}}, ""}}, {});
  page.add_scene(small_scene());
  const std::string html = page.html();
  EXPECT_THAT(html, HasSubstr("<img width=\"3\" height=\"2\" alt=\"red &quot;box&quot;\" "
                              "src=\"data:image/png;base64,iVBORw0KGgo"));
  // Whatever is loaded is within: no address in any attribute that loads.
  const std::regex loads("(src|href)=\"(?!data:)");
  const std::string body = html.substr(0, html.find("<!--"));  // then comes three.js
  EXPECT_FALSE(std::regex_search(body, loads));
  EXPECT_THAT(html, HasSubstr("OrbitControls"));
}

TEST(ReportPage, HasARowForEveryLineOfATable) {
  ReportPage page = empty_page();
  page.add_table({{"method", "error"}, {{"joint", "1"}, {"none", "2"}}});
  EXPECT_THAT(page.html(), HasSubstr("<td>joint</td>\n<td>1</td>"));
  EXPECT_THAT(page.html(), HasSubstr("<th>method</th>"));
}

TEST(ReportPage, PacksAScene) {
  ReportPage page = empty_page();
  page.add_scene(small_scene());
  const nlohmann::json json = scene_json(page.html());
  EXPECT_EQ(json["box"]["max"], (nlohmann::json{1, 2, 4}));
  EXPECT_EQ(json["clouds"][0]["name"], "a </script> cloud");
  EXPECT_EQ(json["clouds"][0]["points"], "AAAAAAAA////////");  // 0 0 0, then all of the box
  EXPECT_EQ(json["clouds"][0]["normals"], "AAB/AAAA");         // 0 0 127, 0 0 0
  EXPECT_EQ(json["clouds"][0]["colorings"][0], "AQIDBAUG");    // 1 2 3 4 5 6
  EXPECT_EQ(json["paths"][0]["color"], 0xff0010);
}

TEST(ReportPage, CanShowAnEmptyScene) {
  ReportPage page = empty_page();
  PageScene scene;
  scene.colorings = {{"height", Picture(2, 2)}};
  scene.clouds = {{"nothing", {}, {}, {{}}}};
  page.add_scene(scene);
  EXPECT_EQ(scene_json(page.html())["clouds"][0]["points"], "");
}

TEST(ReportPage, RefusesPointsWithoutColours) {
  ReportPage page = empty_page();
  PageScene scene = small_scene();
  scene.clouds[0].colorings[0].pop_back();
  EXPECT_THROW(page.add_scene(scene), UsageError);
  scene = small_scene();
  scene.clouds[0].normals.clear();
  EXPECT_THROW(page.add_scene(scene), UsageError);
  scene = small_scene();
  scene.colorings.clear();
  EXPECT_THROW(page.add_scene(scene), UsageError);
}

}  // namespace
}  // namespace tofmap
