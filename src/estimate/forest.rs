//! Sets of nodes that agree or disagree.

/// Disjoint-set forest with parity: each node stores whether it agrees with its parent.
pub(super) struct Forest {
    parent: Vec<u32>,
    /// Whether the node's normal is flipped relative to its parent's.
    flips: Vec<bool>,
}

impl Forest {
    /// Every node by itself.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect(), flips: vec![false; count] }
    }

    /// The root of a node, and whether the node is flipped relative to it.
    pub fn find(&mut self, mut node: u32) -> (u32, bool) {
        let mut flipped = false;
        loop {
            let parent = self.parent[node as usize];
            let above = self.parent[parent as usize];
            if parent == above {
                return (parent, flipped ^ (parent != node && self.flips[node as usize]));
            }
            // Path compression by halving.
            self.flips[node as usize] ^= self.flips[parent as usize];
            self.parent[node as usize] = above;
            flipped ^= self.flips[node as usize];
            node = above;
        }
    }

    /// Makes two nodes agree, or disagree, unless they are connected.
    pub fn join(&mut self, a: u32, b: u32, disagree: bool) {
        let ((root_a, a), (root_b, b)) = (self.find(a), self.find(b));
        if root_a != root_b {
            self.parent[root_b as usize] = root_a;
            self.flips[root_b as usize] = a ^ b ^ disagree;
        }
    }
}
