// SPDX-License-Identifier: BSD-3-Clause
// The graph's promises: slots, ids, symmetric edges, ages, the degree bound.
#include "ddgng/graph.h"

#include <gtest/gtest.h>

namespace ddgng {
namespace {

Eigen::Vector3f on_x(int x) {
  return {static_cast<float>(x), 0.0F, 0.0F};
}

Graph chain(int num_nodes, int max_degree = 4) {
  Graph graph(num_nodes, max_degree);
  for (int i = 0; i < num_nodes; ++i) graph.add_node(on_x(i));
  for (int i = 0; i + 1 < num_nodes; ++i) graph.join(i, i + 1);
  return graph;
}

int age_between(const Graph& graph, int a, int b) {
  for (int k = 0; k < graph.degree(a); ++k) {
    if (graph.neighbours(a)[k] == b) return graph.age(a, k);
  }
  return -1;
}

// A graph without nodes has no slots, and an empty slot is alive to nobody.
TEST(Graph, Empty) {
  const Graph graph(2, 2);
  EXPECT_EQ(graph.num_nodes(), 0);
  EXPECT_EQ(graph.num_slots(), 0);
  EXPECT_FALSE(graph.alive(0));
}

// A new node takes the lowest free slot, and never an id that was used before.
TEST(Graph, ReusesSlotsNotIds) {
  Graph graph = chain(4);
  graph.remove_node(2);
  graph.remove_node(1);
  EXPECT_EQ(graph.add_node(on_x(9)), 1);
  EXPECT_EQ(graph.id(1), 4);
  EXPECT_EQ(graph.add_node(on_x(9)), 2);
  EXPECT_EQ(graph.id(2), 5);
  EXPECT_EQ(graph.num_nodes(), 4);
}

// Removing a node removes its edges from both sides and forgets its place.
TEST(Graph, RemovesEdgesWithTheNode) {
  Graph graph = chain(3);
  graph.remove_node(1);
  EXPECT_EQ(graph.degree(0), 0);
  EXPECT_EQ(graph.degree(2), 0);
  EXPECT_EQ(graph.position_m(1).x(), Graph::kFar_m);
}

// Living slots stay below num_slots when the highest ones die.
TEST(Graph, SlotsShrink) {
  Graph graph = chain(5);
  graph.remove_node(3);
  EXPECT_EQ(graph.num_slots(), 5);
  graph.remove_node(4);
  EXPECT_EQ(graph.num_slots(), 3);
}

// An edge ages with the wins of either end, both ends see the same age, joining makes it young.
TEST(Graph, AgesFromBothEnds) {
  Graph graph = chain(3);
  graph.age_edges(0);
  graph.age_edges(1);
  graph.age_edges(1);
  EXPECT_EQ(age_between(graph, 0, 1), 3);
  EXPECT_EQ(age_between(graph, 1, 0), 3);
  EXPECT_EQ(age_between(graph, 1, 2), 2);
  graph.join(1, 0);
  EXPECT_EQ(age_between(graph, 0, 1), 0);
  EXPECT_EQ(age_between(graph, 2, 1), 2);
}

// Ages stay right when the 16-bit win counters wrap around.
TEST(Graph, AgesSurviveManyWins) {
  Graph graph = chain(2);
  for (int i = 0; i < 70000; ++i) {
    graph.age_edges(0);
    if (i % 100 == 99) graph.join(0, 1);
  }
  for (int i = 0; i < 5; ++i) graph.age_edges(1);
  EXPECT_EQ(age_between(graph, 0, 1), 5);
}

// A full node gives up its oldest edge, of equally old ones the one to the lowest slot.
TEST(Graph, FullNodeGivesUpItsOldestEdge) {
  Graph graph(6, 2);
  for (int i = 0; i < 6; ++i) graph.add_node(on_x(i));
  EXPECT_EQ(graph.join(0, 2), 0);
  EXPECT_EQ(graph.join(0, 1), 0);
  EXPECT_EQ(graph.join(0, 3), 1);
  EXPECT_FALSE(graph.joined(0, 1));
  EXPECT_FALSE(graph.joined(1, 0));
  graph.age_edges(0);
  graph.join(0, 2);
  EXPECT_EQ(graph.join(0, 4), 1);
  EXPECT_FALSE(graph.joined(0, 3));
  EXPECT_TRUE(graph.joined(0, 2));
}

// Joining two full nodes costs each one edge.
TEST(Graph, BothEndsFull) {
  Graph graph(6, 2);
  for (int i = 0; i < 6; ++i) graph.add_node(on_x(i));
  for (const int i : {2, 3}) graph.join(0, i);
  for (const int i : {4, 5}) graph.join(1, i);
  EXPECT_EQ(graph.join(0, 1), 2);
  EXPECT_EQ(graph.degree(0), 2);
  EXPECT_EQ(graph.degree(1), 2);
}

// renumber() keeps the order of ids and closes their gaps.
TEST(Graph, RenumberKeepsTheOrder) {
  Graph graph = chain(4);
  graph.remove_node(0);
  graph.add_node(on_x(9));
  graph.remove_node(2);
  graph.renumber();
  EXPECT_EQ(graph.id(1), 0);
  EXPECT_EQ(graph.id(3), 1);
  EXPECT_EQ(graph.id(0), 2);
  EXPECT_EQ(graph.next_id(), 3);
}

// Moving goes the given share of the way.
TEST(Graph, Moves) {
  Graph graph = chain(2);
  graph.move_towards(1, {3.0F, 4.0F, 0.0F}, 0.5F);
  EXPECT_EQ(graph.position_m(1), Eigen::Vector3f(2.0F, 2.0F, 0.0F));
}

}  // namespace
}  // namespace ddgng
