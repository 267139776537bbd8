// Starts Coin for a program.
#pragma once

namespace app {

/// Initialises Coin, its node kits and this project's classes. Coin's remark that a context without a window system is no GLX
/// context is kept from the user; all its other messages still go where they went.
void startCoin();

}  // namespace app
