//! Pictures equal those of the README and of docs/embedded.md, show the given state, and depend on the seed.

use std::fs::File;
use std::io::BufReader;

use super::{Folder, printed};
use acrobot::physics::Pendulum;
use acrobot::render::{Figure, Frame};
use acrobot::{Acrobot, Params, Portable, State};

fn png(folder: &Folder, name: &str) -> (u32, u32, Vec<u8>) {
    let file = BufReader::new(File::open(folder.path(name)).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width, info.height, bytes)
}

#[test]
fn a_state_is_rendered_as_its_frame() {
    let folder = Folder::new();
    printed(&mut folder.command("render_episode --state -0.6,1.5"));
    let state = State::from([-0.6, 1.5, 0.0, 0.0]);
    let pendulum = Pendulum::<Portable>::new(Params::DEFAULT, state).unwrap();
    let expected = Frame::of(&Figure::new(&Acrobot::from_pendulum(pendulum, ())));
    let expected = (500, 500, expected.bytes().to_vec());
    assert!(png(&folder, "frame.png") == expected);
}

/// The example draws the README's first picture.
#[test]
fn the_episode_equals_the_readmes_picture() {
    let folder = Folder::new();
    printed(&mut folder.command("render_episode"));
    let recorded = include_str!("../../docs/episode.svg");
    let drawn = folder.svg("episode.svg");
    assert!(drawn == recorded, "docs/episode.svg differs");
    // The initial state and 94 steps.
    assert_eq!(folder.gif_frames("episode.gif"), 95);
}

/// rustdoc shows the picture from its definition.
#[test]
fn balancing_equals_the_picture_of_the_page() {
    let folder = Folder::new();
    printed(&mut folder.command("balance --definition balance.txt"));
    let recorded = include_str!("../../docs/balance.svg");
    assert!(
        folder.svg("balance.svg") == recorded,
        "docs/balance.svg differs"
    );
    let recorded = include_bytes!("../../docs/balance.txt");
    assert!(
        folder.read("balance.txt") == recorded,
        "docs/balance.txt differs"
    );
}

#[test]
fn the_portrait_depends_on_the_seed() {
    let folder = Folder::new();
    let [one, other] = [("42", "94 steps"), ("43", "steps")].map(|(seed, steps)| {
        let mut portrait = folder.command(&format!("phase_portrait --seed {seed}"));
        assert!(printed(&mut portrait).contains(steps));
        folder.svg("portrait.svg")
    });
    assert!(one != other, "the seed must change the picture");
}
