//! The kinematic tree, on petgraph: node 0 is the ground (frame 0), node i + 1 is link i.

use super::robot::LinkId;
use crate::arena::Handle;
use petgraph::graph::{DiGraph, NodeIndex};
use petgraph::visit::{Dfs, EdgeRef};

/// Who carries whom. Edges lead from the carrying link to the carried one.
#[derive(Clone, Debug)]
pub struct Tree {
    graph: DiGraph<Option<LinkId>, ()>,
}

impl Tree {
    /// The tree in which link i is carried by `parents[i]`; none stands for the ground.
    pub(crate) fn new(parents: &[Option<LinkId>]) -> Self {
        let mut graph = DiGraph::with_capacity(parents.len() + 1, parents.len());
        graph.add_node(None);
        (0..parents.len()).for_each(|index| {
            graph.add_node(Some(LinkId::from_index(index)));
        });
        // petgraph lists the newest edge first: added backwards, children come in file order
        for (index, parent) in parents.iter().enumerate().rev() {
            graph.add_edge(node(*parent), NodeIndex::new(index + 1), ());
        }
        Self { graph }
    }

    /// The links that `link` carries, in file order; of the ground, those that stand on frame 0.
    pub fn children(&self, link: Option<LinkId>) -> impl Iterator<Item = LinkId> + '_ {
        self.graph.edges(node(link)).filter_map(|edge| self.graph[edge.target()])
    }

    /// The links from the ground to `link`, both ends included.
    pub fn path(&self, link: LinkId) -> Vec<LinkId> {
        let mut path = vec![link];
        let mut at = node(Some(link));
        while let Some(parent) =
            self.graph.neighbors_directed(at, petgraph::Direction::Incoming).next()
        {
            path.extend(self.graph[parent]);
            at = parent;
        }
        path.reverse();
        path
    }

    /// `link` and everything it carries, directly or not, in file order.
    pub fn subtree(&self, link: LinkId) -> Vec<LinkId> {
        let mut walk = Dfs::new(&self.graph, node(Some(link)));
        let mut links = Vec::new();
        while let Some(at) = walk.next(&self.graph) {
            links.extend(self.graph[at]);
        }
        links.sort_unstable();
        links
    }

    /// The links that carry nothing, in file order.
    pub fn tips(&self) -> impl Iterator<Item = LinkId> + '_ {
        let is_tip = |at: &NodeIndex| self.graph.edges(*at).next().is_none();
        self.graph.node_indices().filter(is_tip).filter_map(|at| self.graph[at])
    }
}

fn node(link: Option<LinkId>) -> NodeIndex {
    NodeIndex::new(link.map_or(0, |link| link.index() + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A torso (0, 1) with two legs (2, 3) and (4, 5), written interleaved.
    fn biped() -> Tree {
        Tree::new(&[None, Some(0), Some(1), Some(1), Some(2), Some(3)].map(id))
    }

    fn id(index: Option<usize>) -> Option<LinkId> {
        index.map(LinkId::from_index)
    }

    fn ids(indices: &[usize]) -> Vec<LinkId> {
        indices.iter().map(|&index| LinkId::from_index(index)).collect()
    }

    #[test]
    fn children_paths_and_subtrees_come_in_file_order() {
        let tree = biped();
        assert_eq!(tree.children(None).collect::<Vec<_>>(), ids(&[0]));
        assert_eq!(tree.children(id(Some(1))).collect::<Vec<_>>(), ids(&[2, 3]));
        assert_eq!(tree.path(LinkId::from_index(5)), ids(&[0, 1, 3, 5]));
        assert_eq!(tree.subtree(LinkId::from_index(2)), ids(&[2, 4]));
        assert_eq!(tree.subtree(LinkId::from_index(0)), ids(&[0, 1, 2, 3, 4, 5]));
        assert_eq!(tree.tips().collect::<Vec<_>>(), ids(&[4, 5]));
    }
}
