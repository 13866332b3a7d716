//! Lets the targets find the engine at run time.

fn main() {
    let libdir = std::env::var("DEP_MUJOCO_LIBDIR").expect("mujoco-dist is a direct dependency");
    println!("cargo::rustc-link-arg=-Wl,-rpath,{libdir}");
}
