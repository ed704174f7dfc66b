//! Every scene, traced and sampled, against what is known of it otherwise.
