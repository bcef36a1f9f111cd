//! The plans of `plan` are better than the learnt policy.

use super::{Folder, printed};

#[test]
fn planning_beats_the_learnt_policy_within_fixed_memory() {
    let folder = Folder::new();
    let mut plan = folder.command("plan --learn 300 --episodes 20 --depth 30");
    let text = printed(&mut plan);
    assert_eq!(text, printed(&mut plan));
    let number = |name: &str| -> f64 {
        let (_, rest) = text.split_once(name).unwrap();
        rest.split_whitespace().next().unwrap().parse().unwrap()
    };
    // After 300 episodes the values are coarse.
    assert!(number("30 steps ahead") > -72.0, "{text}");
    assert!(number("30 steps ahead") > number("greedy") + 5.0, "{text}");
    assert!(number("the search takes ") <= 4096.0, "{text}");
}
